#pragma once

#include <map>
#include <optional>
#include <string>

#include "flexcomp/types.hpp"
#include "programs/krl_point.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// A base or a tool as a program names it.
struct KrlFrame {
  std::string name;                   ///< as BASE_DATA[2]; empty where the program says nothing
  std::optional<Pose<double>> value;  ///< where a file tells it
  bool is_loaded = false;             ///< by its name, not in numbers where it is set
  std::size_t line = 0;               ///< that sets it

  bool is_same(const KrlFrame& other) const;
};

/// What an FDAT says of a motion.
struct KrlFrameData {
  KrlFrame tool;
  KrlFrame base;
  bool is_on_tool = false;  ///< IPO_FRAME #TCP: the tool stands still and the robot holds the work
};

/// A point as it is written, and what it is.
struct KrlReadPoint {
  std::string name;               ///< of the first operand; empty for one in braces
  std::optional<KrlPoint> point;  ///< nothing where no file tells it
  std::string why;                ///< why it cannot be read; empty where it only is not told
};

/// A number as it is written, and what it is.
struct KrlReadNumber {
  std::string name;              ///< empty for a number that is none by name
  std::optional<double> number;  ///< nothing where no file tells it
  std::string why;               ///< why it cannot be told; empty where no file tells it
};

/// What a program and its data list declare, by name in capitals.
class KrlData {
 public:
  /// DECL E6POS P1={…}; true for a declaration. `word` is its first word.
  bool read_declaration(std::string word, Scanner* scanner);

  /// Takes what stands behind `name =`. What is computed is not known any more.
  void assign(const std::string& name, Scanner* scanner);

  /// Forgets a variable, and what is a component or an element of it.
  void forget(const std::string& name);

  /// A point in braces or by name, or a product (P1:P2) of whole ones. The letter X before a name
  /// may be left out, as inline forms do.
  KrlReadPoint read_point(Scanner* scanner) const;

  /// A number, or a variable by its name, of which no more than this is read.
  KrlReadNumber read_number(Scanner* scanner) const;

  /// Base or tool by its number: what BASE_DATA[2] is told to be, and $NULLFRAME for 0.
  KrlFrame numbered(const std::string& array, double number) const;

  /// BASE_DATA[2], FP2.BASE_NO, FP2 or 2, as functions of spline motions take them.
  KrlFrame read_frame_name(const std::string& array, Scanner* scanner) const;

  /// An FDAT in braces or by name.
  KrlFrameData read_frame_data(Scanner* scanner) const;

  /// Why motions with an LDAT, in braces or by name, cannot be planned; empty where they can.
  std::string why_no_path(Scanner* scanner) const;

 private:
  std::optional<KrlPoint> find_point(const std::string& name) const;
  KrlReadPoint read_operand(Scanner* scanner) const;
  KrlFrameData frame_data_of(const std::vector<KrlComponent>& aggregate,
                             const std::string& name) const;

  std::map<std::string, KrlPoint> points_;
  std::map<std::string, std::vector<KrlComponent>> others_;  ///< FDAT, LDAT
  /// Variables that a value is given; nothing where it is computed, or is none.
  std::map<std::string, std::optional<double>> numbers_;
};

/// A name with its index where it is an element of BASE_DATA or TOOL_DATA; the name alone where
/// the index is computed.
std::string krl_indexed_name(std::string name, Scanner* scanner);

}  // namespace flexcomp::programs
