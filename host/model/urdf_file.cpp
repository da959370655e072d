#include "model/urdf_file.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <set>
#include <string>
#include <vector>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "model/urdf_values.hpp"

namespace flexcomp::model {
namespace {

/// Collects what urdfdom would print on standard error for as long as it lives.
class ParserMessages : public console_bridge::OutputHandler {
 public:
  ParserMessages() { console_bridge::useOutputHandler(this); }
  ParserMessages(const ParserMessages&) = delete;
  ParserMessages& operator=(const ParserMessages&) = delete;
  ~ParserMessages() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*filename*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      errors_ += (errors_.empty() ? "" : "; ") + text;
    }
  }

  const std::string& errors() const { return errors_; }

 private:
  std::string errors_;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  constexpr std::size_t kLongest = 300;
  throw InputError(
      fmt::format("{}: not a valid URDF: {}", file.string(), files::one_line(why, kLongest)));
}

/// TinyXML, which urdfdom parses with, calls itself for every level and would overflow the stack.
void refuse_endless_nesting(const std::filesystem::path& file, const std::string& text) {
  constexpr std::ptrdiff_t kMostElements = 10000;
  if (std::count(text.begin(), text.end(), '<') > 2 * kMostElements) {
    throw InputError(
        fmt::format("{}: expected at most {} XML elements", file.string(), kMostElements));
  }
}

/// Finds the first element of xacro, or the first value that xacro would compute.
class XacroSearch : public TiXmlVisitor {
 public:
  bool VisitEnter(const TiXmlElement& element, const TiXmlAttribute* attribute) override {
    if (element.ValueStr().rfind("xacro:", 0) == 0) {
      take(element, "<" + element.ValueStr() + ">");
    }
    for (; attribute != nullptr; attribute = attribute->Next()) {
      if (attribute->ValueStr().find("${") != std::string::npos ||
          attribute->ValueStr().find("$(") != std::string::npos) {
        take(element, attribute->ValueStr());
      }
    }
    return found_.empty();
  }

  const std::string& found() const { return found_; }
  int line() const { return line_; }

 private:
  void take(const TiXmlElement& element, const std::string& found) {
    if (found_.empty()) {
      found_ = found;
      line_ = element.Row();
    }
  }

  std::string found_;
  int line_ = 0;
};

/// A name for the expanded file, which is not that of the file itself.
std::string name_of_expanded(const std::filesystem::path& file) {
  const bool says_xacro = file.extension() == ".xacro" && file.stem().extension() == ".urdf";
  return says_xacro ? file.stem().string() : file.stem().string() + "_expanded.urdf";
}

void refuse_xacro(const std::filesystem::path& file, const TiXmlDocument& document) {
  XacroSearch search;
  document.Accept(&search);
  if (!search.found().empty()) {
    throw InputError(fmt::format(
        "{0}:{1}: xacro is left in it: '{2}'; expand it first: xacro {0} > {3}", file.string(),
        search.line(), files::one_line(search.found()), name_of_expanded(file)));
  }
}

/// urdfdom parses again, tells no line, and takes for zero or leaves out what it cannot read.
void refuse_what_urdfdom_cannot_read(const std::filesystem::path& file, const std::string& text) {
  TiXmlDocument document;
  document.Parse(text.c_str());
  if (document.Error()) {
    throw InputError(fmt::format("{}:{}: not valid XML: {}", file.string(), document.ErrorRow(),
                                 document.ErrorDesc()));
  }
  refuse_xacro(file, document);
  refuse_unreadable_values(file.string(), document);
}

/// urdfdom takes for granted that links form a tree: who walks one with a loop never arrives, and
/// the memory of a loop is never freed.
void refuse_what_is_no_tree(const std::filesystem::path& file, const urdf::ModelInterface& model) {
  std::string why;
  std::set<std::string> children;
  for (const auto& [name, joint] : model.joints_) {
    if (!children.insert(joint->child_link_name).second) {
      why = fmt::format("link '{}' is the child of two joints", joint->child_link_name);
    }
  }
  // Each link has at most one joint above it now, so that this ends.
  std::vector<urdf::LinkConstSharedPtr> open = {model.getRoot()};
  std::size_t reached = 0;
  while (why.empty() && !open.empty()) {
    const urdf::LinkConstSharedPtr link = open.back();
    open.pop_back();
    open.insert(open.end(), link->child_links.begin(), link->child_links.end());
    ++reached;
  }
  if (why.empty() && reached == model.links_.size()) {
    return;
  }
  for (const auto& [name, link] : model.links_) {
    link->child_links.clear();
  }
  fail(file, why.empty() ? "its links form a loop" : why);
}

}  // namespace

urdf::ModelInterfaceSharedPtr read_urdf(const std::filesystem::path& file) {
  const std::string text = files::read_text(file, files::kLargestDescription);
  refuse_endless_nesting(file, text);
  refuse_what_urdfdom_cannot_read(file, text);
  const ParserMessages messages;
  urdf::ModelInterfaceSharedPtr tree;
  try {
    tree = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    fail(file, error.what());
  }
  if (!tree) {
    fail(file, messages.errors());
  }
  refuse_what_is_no_tree(file, *tree);
  return tree;
}

}  // namespace flexcomp::model
