#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "host/scratch_folder.hpp"
#include "linux/whole_file.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr std::size_t kMost = 1000;

/// The complaint, without the folder; empty if there is none.
std::string complaint(const test::ScratchFolder& folder, const std::function<void()>& what) {
  try {
    what();
    return "";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    const std::string before = (folder / "").string();
    return said.compare(0, before.size(), before) == 0 ? said.substr(before.size()) : said;
  }
}

std::string complaint_of_reading(const test::ScratchFolder& folder, const std::string& name) {
  return complaint(folder, [&] { read_whole(folder / name, kMost); });
}

std::string complaint_of_writing(const test::ScratchFolder& folder, const std::string& name) {
  return complaint(folder, [&] { write_whole(folder / name, "new", 3); });
}

void a_file_is_read_whole_up_to_the_limit() {
  const test::ScratchFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kMost}) {
    const std::string content(size, 'x');
    test::put(folder / "file", content);
    const auto bytes = read_whole(folder / "file", kMost);
    TEST_ASSERT_TRUE(bytes.has_value());
    TEST_ASSERT_TRUE(std::string(bytes->begin(), bytes->end()) == content);
  }
  TEST_ASSERT_FALSE(read_whole(folder / "none", kMost).has_value());
}

void a_larger_file_is_refused_before_it_takes_memory() {
  const test::ScratchFolder folder;
  test::put(folder / "large", std::string(kMost + 1, 'x'));
  TEST_ASSERT_EQUAL_STRING("large: larger than 1000 bytes",
                           complaint_of_reading(folder, "large").c_str());
  // Says that it is empty and holds more than a byte.
  TEST_ASSERT_EQUAL_STRING("/proc/self/status: larger than 1 bytes",
                           complaint(folder, [] { read_whole("/proc/self/status", 1); }).c_str());
}

/// Ends the test program, and so the test, where something waits for another process.
void what_is_no_ordinary_file_is_refused_without_waiting() {
  const test::ScratchFolder folder;
  mkfifo((folder / "fifo").c_str(), 0600);
  mkfifo((folder / "text.new").c_str(), 0600);
  std::filesystem::create_directory(folder / "folder");
  std::filesystem::create_symlink("/dev/null", folder / "link.new");
  alarm(10);
  TEST_ASSERT_EQUAL_STRING("fifo: not an ordinary file",
                           complaint_of_reading(folder, "fifo").c_str());
  TEST_ASSERT_EQUAL_STRING("folder: not an ordinary file",
                           complaint_of_reading(folder, "folder").c_str());
  TEST_ASSERT_EQUAL_STRING("/dev/zero: not an ordinary file",
                           complaint(folder, [] { read_whole("/dev/zero", kMost); }).c_str());
  TEST_ASSERT_EQUAL_STRING("text.new: not an ordinary file",
                           complaint_of_writing(folder, "text").c_str());
  TEST_ASSERT_EQUAL_STRING("link.new: not an ordinary file",
                           complaint_of_writing(folder, "link").c_str());
  alarm(0);
}

void a_file_is_replaced_whole_whatever_stood_aside() {
  const test::ScratchFolder folder;
  test::put(folder / "text", "old");
  test::put(folder / "text.new", "half of what was never finished");
  TEST_ASSERT_EQUAL_STRING("", complaint_of_writing(folder, "text").c_str());
  TEST_ASSERT_EQUAL_STRING("new", test::content_of(folder / "text").c_str());
  TEST_ASSERT_EQUAL(1, folder.file_count());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_file_is_read_whole_up_to_the_limit);
  RUN_TEST(a_larger_file_is_refused_before_it_takes_memory);
  RUN_TEST(what_is_no_ordinary_file_is_refused_without_waiting);
  RUN_TEST(a_file_is_replaced_whole_whatever_stood_aside);
  return UNITY_END();
}
