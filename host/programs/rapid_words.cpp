#include "programs/rapid_words.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace flexcomp::programs {
namespace {

const std::set<std::string> kRapidReadable = {"MOVEJ", "MOVEL", "MOVEC", "MOVEABSJ"};
const std::set<std::string> kRapidUnreadable = {
    "MOVEJDO",  "MOVEJAO",   "MOVEJGO",        "MOVEJSYNC",      "MOVELDO",        "MOVELAO",
    "MOVELGO",  "MOVELSYNC", "MOVECDO",        "MOVECAO",        "MOVECGO",        "MOVECSYNC",
    "MOVEEXTJ", "MOVEPNP",   "SEARCHL",        "SEARCHC",        "SEARCHEXTJ",     "TRIGGL",
    "TRIGGC",   "TRIGGJ",    "TRIGGABSJ",      "TRIGGLIOS",      "TRIGGJIOS",      "TRIGGCIOS",
    "CAPL",     "CAPC",      "PATHRECMOVEBWD", "PATHRECMOVEFWD", "PAINTL",         "PAINTC",
    "DISPL",    "DISPC",     "SPOTL",          "SPOTJ",          "SPOTML",         "SPOTMJ",
    "NUTL",     "NUTJ",      "FCPRESSL",       "FCPRESSC",       "FCPRESS1LSTART", "FCPRESSEND",
    "FCPROCL",  "EGMMOVEL",  "EGMMOVEC",       "EGMRUNJOINT",    "EGMRUNPOSE",     "INDAMOVE",
    "INDCMOVE", "INDDMOVE",  "INDRMOVE",       "EXECENGINE",     "STARTMOVERETRY"};
constexpr std::array<std::string_view, 2> kArcsBegin = {"ARCL", "ARCC"};
const std::set<std::string> kRapidOpening = {"FOR", "WHILE", "TEST", "ERROR", "UNDO", "BACKWARD"};
const std::set<std::string> kRapidClosing = {"ENDIF", "ENDFOR", "ENDWHILE", "ENDTEST"};
const std::set<std::string> kRapidRoutines = {"PROC", "FUNC", "TRAP"};
const std::set<std::string> kRapidDisplacing = {"PDISPON", "PDISPSET", "EOFFSON", "EOFFSSET"};
const std::set<std::string> kRapidWithoutMotion = {
    "MODULE",   "ENDMODULE", "ENDPROC",   "ENDFUNC",   "ENDTRAP",    "ELSE",     "ELSEIF",
    "CASE",     "DEFAULT",   "RECORD",    "ENDRECORD", "STOP",       "CONFL",    "CONFJ",
    "ACCSET",   "RESET",     "SET",       "INCR",      "DECR",       "ADD",      "CLEAR",
    "ACTUNIT",  "DEACTUNIT", "GRIPLOAD",  "CONNECT",   "RAISE",      "RETRY",    "TRYNEXT",
    "PULSEDO",  "LABEL",     "OPEN",      "CLOSE",     "WRITE",      "CLKSTART", "CLKSTOP",
    "CLKRESET", "STOPMOVE",  "STARTMOVE", "TRIGGIO",   "TRIGGEQUIP", "TRIGGINT", "PATHACCLIM",
    "PATHRESOL"};
constexpr std::array<std::string_view, 5> kWithoutMotionBegin = {"SETDO", "SETAO", "SETGO", "WAIT",
                                                                 "TP"};

template <std::size_t Count>
bool begins_with_one_of(const std::array<std::string_view, Count>& beginnings,
                        const std::string& word) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view each) {
    return word.compare(0, each.size(), each) == 0;
  });
}

}  // namespace

bool is_rapid_motion(const std::string& word) {
  return kRapidReadable.count(word) > 0 || is_unreadable_rapid_motion(word);
}

bool is_unreadable_rapid_motion(const std::string& word) {
  return kRapidUnreadable.count(word) > 0 ||
         (begins_with_one_of(kArcsBegin, word) && word.find('_') == std::string::npos);
}

bool is_rapid_without_motion(const std::string& word) {
  return kRapidWithoutMotion.count(word) > 0 || begins_with_one_of(kWithoutMotionBegin, word);
}

bool opens_rapid_block(const std::string& word) { return kRapidOpening.count(word) > 0; }
bool closes_rapid_block(const std::string& word) { return kRapidClosing.count(word) > 0; }
bool begins_rapid_routine(const std::string& word) { return kRapidRoutines.count(word) > 0; }
bool ends_rapid_routine(const std::string& word) {
  return word.compare(0, 3, "END") == 0 && begins_rapid_routine(word.substr(3));
}
bool displaces_rapid_motions(const std::string& word) { return kRapidDisplacing.count(word) > 0; }

}  // namespace flexcomp::programs
