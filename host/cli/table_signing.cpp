#include "cli/table_signing.hpp"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <vector>

#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/table.hpp"
#include "linux/key_file.hpp"
#include "messages/table_signature.hpp"

namespace flexcomp::cli {
namespace {

constexpr std::size_t kLargestTable = std::size_t{1} << 30;

struct SignOptions {
  std::string table;
  std::string out;
  SigningOptions signing;
};

AuthenticationKey key_in(const std::string& file) {
  try {
    return read_key(file);
  } catch (const std::runtime_error& error) {
    throw InputError(error.what());
  }
}

/// The table of a file without its trailer, if it has one; checked.
std::string bare_table(const std::string& file) {
  std::string bytes = files::read_file(file, kLargestTable);
  bytes.resize(bytes_of_table(bytes.data(), bytes.size()));
  std::vector<std::uint32_t> words((bytes.size() + 3) / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  Table table;
  const Result opened = Table::open(words.data(), bytes.size(), &table);
  if (opened != Result::ok) {
    throw InputError(fmt::format("{}: {}", file, describe(opened)));
  }
  return bytes;
}

int run_sign(const SignOptions& options) {
  const std::string table = bare_table(options.table);
  const std::string& out = options.out.empty() ? options.table : options.out;
  files::write_text(out, table + trailer_for(table, options.signing));
  fmt::print("{}: signed as version {}\n", out, options.signing.counter);
  return kDone;
}

}  // namespace

void add_signing(CLI::App* command, SigningOptions* options) {
  CLI::Option* key =
      command->add_option("--key", options->key,
                          "sign with the key in this file, 32 hexadecimal digits; a node that has\n"
                          "it takes only tables signed with it");
  CLI::Option* counter = command->add_option(
      "--counter", options->counter,
      "version to sign as: a node refuses a table with a lower one than it has run with");
  key->needs(counter);
  counter->needs(key);
}

std::string trailer_for(const std::string& table, const SigningOptions& options) {
  if (options.key.empty()) {
    return {};
  }
  const std::optional<TableTrailer> trailer =
      sign_table(key_in(options.key), table.data(), table.size(), options.counter);
  if (!trailer) {
    throw std::runtime_error("mbedTLS does not sign");
  }
  return {reinterpret_cast<const char*>(&*trailer), sizeof *trailer};
}

std::uint32_t signed_version(const std::string& table_file, const std::string& key_file) {
  const AuthenticationKey key = key_in(key_file);
  const std::string bytes = files::read_file(table_file, kLargestTable);
  std::uint32_t counter = 0;
  switch (check_signature(key, bytes.data(), bytes.size(), &counter)) {
    case Signature::good:
      return counter;
    case Signature::none:
      throw InputError(fmt::format("{}: not signed", table_file));
    case Signature::wrong:
      break;
  }
  throw InputError(
      fmt::format("{}: its signature is of another key or of other content", table_file));
}

CLI::App* add_table_sign(CLI::App* table, Action* action) {
  CLI::App* command = table->add_subcommand(
      "sign",
      "Sign a table, in place or into another file; a signature that it has already is replaced.\n"
      "Example: flexcomp table sign t.fct --key key --counter 7");
  auto options = std::make_shared<SignOptions>();
  command->add_option("table", options->table, "table to sign")->required();
  add_signing(command, &options->signing);
  command->get_option("--key")->required();
  command->add_option("--out", options->out, "file to write; if not given, the table itself");
  command->callback([=] { *action = [=] { return run_sign(*options); }; });
  return command;
}

}  // namespace flexcomp::cli
