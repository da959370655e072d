#include "programs/rapid_statements.hpp"

#include <set>

#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

/// First words of what ends with its line.
const std::set<std::string> kHeaders = {
    "MODULE",  "ENDMODULE", "PROC",    "ENDPROC", "FUNC",   "ENDFUNC", "TRAP",      "ENDTRAP",
    "ELSE",    "ELSEIF",    "ENDIF",   "FOR",     "ENDFOR", "WHILE",   "ENDWHILE",  "TEST",
    "ENDTEST", "CASE",      "DEFAULT", "ERROR",   "UNDO",   "RECORD",  "ENDRECORD", "BACKWARD"};

constexpr std::size_t kLongestCondition = 1000;

/// Does a statement that has come to the end of a line end there?
bool ends_with_line(const std::string& text) {
  Scanner scanner(text);
  std::string word = scanner.name();
  if (word == "LOCAL" || word == "TASK") {
    word = scanner.name();
  }
  if (word == "IF") {  // else it is one statement with a condition, and ends with a semicolon
    const std::string_view rest = scanner.rest().substr(0, kLongestCondition);
    return rest.find("THEN") != std::string_view::npos ||
           rest.find("then") != std::string_view::npos ||
           rest.find("Then") != std::string_view::npos;
  }
  return kHeaders.count(word) > 0;
}

}  // namespace

void RapidStatements::skip_comment() {
  while (at_ < text_.size() && text_[at_] != '\n') {
    ++at_;
  }
}

void RapidStatements::skip_blanks() {
  constexpr std::string_view kBlanks = " \t\r\n;";
  while (at_ < text_.size()) {
    if (text_[at_] == '!') {
      skip_comment();
    } else if (kBlanks.find(text_[at_]) == std::string_view::npos) {
      return;
    } else {
      line_ += text_[at_] == '\n' ? 1 : 0;
      ++at_;
    }
  }
}

void RapidStatements::skip_file_header() {
  constexpr std::string_view kMark = "%%%";
  if (text_.substr(at_, kMark.size()) != kMark) {
    return;
  }
  const std::size_t end = text_.find(kMark, at_ + kMark.size());
  const std::size_t after = end == std::string_view::npos ? text_.size() : end + kMark.size();
  for (; at_ < after; ++at_) {
    line_ += text_[at_] == '\n' ? 1 : 0;
  }
  skip_blanks();
}

bool RapidStatements::next(RapidStatement* statement) {
  skip_blanks();
  skip_file_header();
  statement->text.clear();
  statement->line = line_;
  statement->begin = at_;
  bool is_text = false;
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == '!' && !is_text) {
      skip_comment();
      continue;
    }
    ++at_;
    if (c == ';' && !is_text) {
      break;
    }
    if (c == '\n') {
      is_text = false;  // a text ends in its line
      ++line_;
      if (ends_with_line(statement->text)) {
        break;
      }
    }
    is_text = is_text != (c == '"');
    statement->text += c == '\n' || c == '\r' ? ' ' : c;
  }
  statement->finish = at_;
  return !statement->text.empty();
}

}  // namespace flexcomp::programs
