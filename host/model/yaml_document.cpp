#include "model/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>
#include <string>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"

namespace flexcomp::model {
namespace {

/// Lets a document pass by.
class Skip : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}
};

/// YAML::Load ignores what follows, and YAML::LoadAll runs for ever on a stray comma.
bool goes_on_after_first_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Skip skip;
  parser.HandleNextDocument(skip);
  return static_cast<bool>(parser);
}

}  // namespace

YAML::Node read_yaml(const std::filesystem::path& file) {
  const std::string text = files::read_text(file, files::kLargestDescription);
  try {
    if (goes_on_after_first_document(text)) {
      throw InputError(
          fmt::format("{}: expected one YAML document and nothing after it", file.string()));
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : fmt::format(":{}", error.mark.line + 1);
    throw InputError(fmt::format("{}{}: not valid YAML: {}", file.string(), line,
                                 files::one_line(error.msg, 200)));
  }
}

}  // namespace flexcomp::model
