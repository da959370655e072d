#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "linux/key_file.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

class KeyFile {
 public:
  explicit KeyFile(const std::string& content, mode_t mode = 0600) {
    close(mkstemp(path_));
    std::ofstream(path_, std::ios::binary) << content;
    chmod(path_, mode);
  }
  ~KeyFile() { std::remove(path_); }
  KeyFile(const KeyFile&) = delete;
  KeyFile& operator=(const KeyFile&) = delete;

  const char* path() const { return path_; }

  /// The complaint, without the path; empty if it is taken.
  std::string complaint() const {
    try {
      read_key(path_);
      return "";
    } catch (const std::runtime_error& error) {
      TEST_ASSERT_EQUAL_STRING_LEN(path_, error.what(), std::strlen(path_));
      return error.what() + std::strlen(path_) + 2;
    }
  }

 private:
  char path_[24] = "key-file-test-XXXXXX";
};

const std::string kDigits = "000102030405060708090a0B0C0d0e0F";

void digits_are_read_in_order_with_a_line_end_or_without() {
  for (const char* end : {"", "\n"}) {
    const KeyFile file(kDigits + end);
    const AuthenticationKey key = read_key(file.path());
    for (std::size_t i = 0; i < key.size(); ++i) {
      TEST_ASSERT_EQUAL_HEX8(i, key[i]);
    }
  }
}

void anything_but_32_digits_is_refused() {
  const std::string with_nul = kDigits.substr(0, 31) + '\0';
  for (const std::string& content :
       {std::string(), kDigits.substr(1), kDigits + "0", kDigits + "\n\n", kDigits + "\r\n",
        " " + kDigits, "g" + kDigits.substr(1), kDigits + kDigits, with_nul}) {
    TEST_ASSERT_EQUAL_STRING("expected a key of 32 hexadecimal digits",
                             KeyFile(content).complaint().c_str());
  }
}

void a_key_that_others_can_read_or_write_is_refused() {
  for (const mode_t mode : {0640U, 0604U, 0620U, 0602U, 0644U, 0610U}) {
    TEST_ASSERT_EQUAL_STRING("others than its owner have access to this key (chmod 600)",
                             KeyFile(kDigits, mode).complaint().c_str());
  }
  TEST_ASSERT_EQUAL_STRING("", KeyFile(kDigits, 0400).complaint().c_str());
}

void what_is_no_file_is_refused() {
  TEST_ASSERT_EQUAL_STRING("/dev/null: a key is expected in an ordinary file",
                           [] {
                             try {
                               read_key("/dev/null");
                               return std::string();
                             } catch (const std::runtime_error& error) {
                               return std::string(error.what());
                             }
                           }()
                               .c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(digits_are_read_in_order_with_a_line_end_or_without);
  RUN_TEST(anything_but_32_digits_is_refused);
  RUN_TEST(a_key_that_others_can_read_or_write_is_refused);
  RUN_TEST(what_is_no_file_is_refused);
  return UNITY_END();
}
