#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>
#include <ostream>
#include <thread>

#include "error.hpp"
#include "files/text_file.hpp"
#include "host/scratch_folder.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::InputError;
using flexcomp::files::read_file;
using flexcomp::files::read_text;
using flexcomp::files::write_file;
using flexcomp::files::write_texts;
using flexcomp::test::content_of;
using flexcomp::test::put;
using flexcomp::test::refusal_of;
using flexcomp::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLimit = 1 << 20;

void write_text(const fs::path& path, const std::string& text) {
  write_file(path, [&](std::ostream& stream) { stream << text; });
}

/// While it lives, files of this process cannot grow past `bytes`, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

void unreadable_paths_are_refused_with_the_reason() {
  const ScratchFolder folder;
  const fs::path file = folder / "file";
  const std::string name = file.string();
  TEST_ASSERT_EQUAL_STRING((name + ": no such file").c_str(),
                           refusal_of([&] { read_text(file); }).c_str());
  put(file, "");
  TEST_ASSERT_EQUAL_STRING((name + ": the file is empty").c_str(),
                           refusal_of([&] { read_text(file); }).c_str());
  put(file, std::string("PK\3\4\0\0", 6));
  TEST_ASSERT_EQUAL_STRING((name + ": not a text file").c_str(),
                           refusal_of([&] { read_text(file); }).c_str());
  TEST_ASSERT_EQUAL_STRING("/: is a directory; expected a file",
                           refusal_of([] { read_text("/"); }).c_str());
}

/// None of them has an end, or one that is worth waiting for.
void devices_sockets_and_files_beyond_the_limit_are_refused_unread() {
  for (const char* device : {"/dev/zero", "/dev/null", "/dev/urandom", "/dev/full"}) {
    TEST_ASSERT_EQUAL_STRING(
        (std::string(device) + ": is a device or socket; expected a file").c_str(),
        refusal_of([&] { read_file(device, kLimit); }).c_str());
  }
  const ScratchFolder folder;
  put(folder / "huge", "");
  fs::resize_file(folder / "huge", std::uintmax_t{1} << 42);
  TEST_ASSERT_EQUAL_STRING(((folder / "huge").string() + ": larger than 1 MiB").c_str(),
                           refusal_of([&] { read_file(folder / "huge", kLimit); }).c_str());
}

void a_pipe_is_read_up_to_the_limit() {
  const ScratchFolder folder;
  const std::string pipe = (folder / "pipe").string();
  TEST_ASSERT_EQUAL(0, ::mkfifo(pipe.c_str(), 0600));
  std::thread writer([&] { std::ofstream(pipe) << "through a pipe"; });
  TEST_ASSERT_EQUAL_STRING("through a pipe", read_text(pipe).c_str());
  writer.join();
  ::signal(SIGPIPE, SIG_IGN);
  writer = std::thread([&] { std::ofstream(pipe) << std::string(4 * kLimit, 'x'); });
  TEST_ASSERT_EQUAL_STRING((pipe + ": larger than 1 MiB").c_str(),
                           refusal_of([&] { read_file(pipe, kLimit); }).c_str());
  writer.join();
}

void what_is_written_is_read_back_and_nothing_else_is_left() {
  const ScratchFolder folder;
  std::string text;
  for (int byte = 1; byte < 256; ++byte) {
    text += static_cast<char>(byte);
  }
  put(folder / "file", "before");
  write_text(folder / "file", text);
  TEST_ASSERT_TRUE(text == read_text(folder / "file"));
  TEST_ASSERT_EQUAL(1, folder.file_count());
}

void a_full_disk_leaves_the_old_file_and_no_other() {
  const ScratchFolder folder;
  const fs::path file = folder / "file";
  put(file, "before");
  std::string message;
  {
    const FullDisk disk(10000);
    message = refusal_of([&] { write_text(file, std::string(1 << 20, 'x')); });
  }
  TEST_ASSERT_EQUAL_STRING((file.string() + ": cannot be written: File too large").c_str(),
                           message.c_str());
  TEST_ASSERT_EQUAL_STRING("before", content_of(file).c_str());
  TEST_ASSERT_EQUAL(1, folder.file_count());
}

void of_several_files_none_is_written_if_one_cannot_be() {
  const ScratchFolder folder;
  put(folder / "first", "before");
  fs::create_directory(folder / "last");
  const std::string message = refusal_of([&] {
    write_texts(
        {{folder / "first", "after"}, {folder / "new", "after"}, {folder / "last", "after"}});
  });
  TEST_ASSERT_EQUAL_STRING(
      ((folder / "last").string() + ": is a directory; expected a file to write").c_str(),
      message.c_str());
  TEST_ASSERT_EQUAL_STRING("before", content_of(folder / "first").c_str());
  TEST_ASSERT_EQUAL(2, folder.file_count());
  write_texts({{folder / "first", "after"}, {folder / "new", "new"}});
  TEST_ASSERT_EQUAL_STRING("after", content_of(folder / "first").c_str());
  TEST_ASSERT_EQUAL_STRING("new", content_of(folder / "new").c_str());
  TEST_ASSERT_EQUAL(3, folder.file_count());
}

void a_full_device_is_one_clear_error() {
  TEST_ASSERT_EQUAL_STRING("/dev/full: cannot be written: No space left on device",
                           refusal_of([] { write_text("/dev/full", "text"); }).c_str());
}

void a_writer_that_throws_leaves_the_old_file_and_its_own_message() {
  const ScratchFolder folder;
  put(folder / "file", "before");
  const std::string message = refusal_of([&] {
    write_file(folder / "file", [](std::ostream& stream) {
      stream << "half";
      throw InputError("the writer's own");
    });
  });
  TEST_ASSERT_EQUAL_STRING("the writer's own", message.c_str());
  TEST_ASSERT_EQUAL_STRING("before", content_of(folder / "file").c_str());
  TEST_ASSERT_EQUAL(1, folder.file_count());
}

void an_interrupted_write_can_be_cleaned_up() {
  const ScratchFolder folder;
  std::size_t during = 0;
  std::size_t after = 1;
  refusal_of([&] {
    write_file(folder / "file", [&](std::ostream& stream) {
      stream << "half" << std::flush;
      during = folder.file_count();
      flexcomp::files::remove_unfinished_file();
      after = folder.file_count();
      throw InputError("interrupted");
    });
  });
  TEST_ASSERT_EQUAL(1, during);
  TEST_ASSERT_EQUAL(0, after);
}

void a_device_is_written_to_and_stays_a_device() {
  write_text("/dev/null", "text");
  TEST_ASSERT_TRUE(fs::is_character_file("/dev/null"));
}

void a_link_is_written_through() {
  const ScratchFolder folder;
  put(folder / "target", "before");
  fs::create_symlink("target", folder / "link");
  write_text(folder / "link", "after");
  TEST_ASSERT_TRUE(fs::is_symlink(folder / "link"));
  TEST_ASSERT_EQUAL_STRING("after", content_of(folder / "target").c_str());
}

void places_that_hold_no_file_are_refused() {
  const ScratchFolder folder;
  fs::create_symlink("nowhere", folder / "link");
  const std::string reason = ": cannot be written: No such file or directory";
  TEST_ASSERT_EQUAL_STRING(((folder / "link").string() + reason).c_str(),
                           refusal_of([&] { write_text(folder / "link", "text"); }).c_str());
  TEST_ASSERT_EQUAL_STRING(((folder / "no/file").string() + reason).c_str(),
                           refusal_of([&] { write_text(folder / "no/file", "text"); }).c_str());
  TEST_ASSERT_EQUAL_STRING("/: is a directory; expected a file to write",
                           refusal_of([] { write_text("/", "text"); }).c_str());
}

void the_permissions_of_a_replaced_file_are_kept() {
  const ScratchFolder folder;
  put(folder / "file", "before");
  const fs::perms secret = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(folder / "file", secret);
  write_text(folder / "file", "after");
  TEST_ASSERT_TRUE(fs::status(folder / "file").permissions() == secret);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(unreadable_paths_are_refused_with_the_reason);
  RUN_TEST(devices_sockets_and_files_beyond_the_limit_are_refused_unread);
  RUN_TEST(a_pipe_is_read_up_to_the_limit);
  RUN_TEST(what_is_written_is_read_back_and_nothing_else_is_left);
  RUN_TEST(a_full_disk_leaves_the_old_file_and_no_other);
  RUN_TEST(of_several_files_none_is_written_if_one_cannot_be);
  RUN_TEST(a_full_device_is_one_clear_error);
  RUN_TEST(a_writer_that_throws_leaves_the_old_file_and_its_own_message);
  RUN_TEST(an_interrupted_write_can_be_cleaned_up);
  RUN_TEST(a_device_is_written_to_and_stays_a_device);
  RUN_TEST(a_link_is_written_through);
  RUN_TEST(places_that_hold_no_file_are_refused);
  RUN_TEST(the_permissions_of_a_replaced_file_are_kept);
  return UNITY_END();
}
