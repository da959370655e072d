#pragma once

#include <set>
#include <string>

#include "programs/scanner.hpp"

/// First words of KRL's statements, in capitals, and what is told by them.
namespace flexcomp::programs {

inline const std::set<std::string> kKrlOpening = {"IF", "FOR", "WHILE", "REPEAT", "LOOP", "SWITCH"};
inline const std::set<std::string> kKrlClosing = {"ENDIF", "ENDFOR",  "ENDWHILE",
                                                  "UNTIL", "ENDLOOP", "ENDSWITCH"};
inline const std::set<std::string> kKrlUnreadable = {
    "SPL", "SPLINE", "PTP_SPLINE", "SPL_REL", "CIRC_REL", "SCIRC_REL", "PTP_REL", "SPTP_REL"};
inline const std::set<std::string> kKrlMotions = {"LIN", "SLIN", "LIN_REL", "SLIN_REL",
                                                  "PTP", "SPTP", "CIRC",    "SCIRC"};
inline const std::set<std::string> kKrlLeaving = {"RETURN", "EXIT", "GOTO", "END", "ENDFCT"};
inline const std::set<std::string> kKrlWithoutMotion = {
    "DEFDAT", "ENDDAT", "EXT",       "EXTFCT", "INI",     "INTERRUPT", "GLOBAL",
    "SIGNAL", "ENUM",   "STRUC",     "WAIT",   "HALT",    "PULSE",     "TRIGGER",
    "BOOL",   "CHAR",   "ELSE",      "CASE",   "DEFAULT", "CONTINUE",  "IMPORT",
    "ANOUT",  "ANIN",   "DIGIN",     "CCLOSE", "COPEN",   "CWRITE",    "CREAD",
    "SREAD",  "SWRITE", "ENDSPLINE", "DECL",   "BRAKE"};
inline const std::set<std::string> kKrlPassing = {"C_DIS", "C_VEL", "C_ORI", "C_PTP", "C_SPL"};

/// DEF or DEFFCT, known in other files too where GLOBAL stands before it.
inline bool begins_krl_routine(const std::string& word, Scanner behind) {
  const std::string kind = word == "GLOBAL" ? behind.name() : word;
  return kind == "DEF" || kind == "DEFFCT";
}

/// Does something follow THEN in the line? `behind` stands behind IF.
inline bool has_krl_statement_behind_then(Scanner behind) {
  while (!behind.at_end()) {
    const std::string each = behind.name();
    if (each == "THEN") {
      return !behind.at_end();
    }
    behind.go_to(behind.place() + (each.empty() ? 1 : 0));
  }
  return false;
}

}  // namespace flexcomp::programs
