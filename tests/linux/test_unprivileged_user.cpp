#include <grp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "linux/unprivileged_user.hpp"
#include "unity_main.hpp"

using flexcomp::UnprivilegedUser;

namespace {

bool is_refused(const char* name) {
  try {
    const UnprivilegedUser user(name);
    return false;
  } catch (const std::runtime_error&) {
    return true;
  }
}

void who_is_not_there_or_is_root_is_refused() {
  TEST_ASSERT_TRUE(is_refused("nobody-has-this-name"));
  TEST_ASSERT_TRUE(is_refused("root"));
  TEST_ASSERT_TRUE(is_refused(""));
}

/// Exit code 0 if `check` holds in a process of its own.
template <typename Check>
int in_a_child(const Check& check) {
  const pid_t child = fork();
  if (child == 0) {
    _exit(check() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void skip_unless_root() {
  if (geteuid() != 0) {
    TEST_IGNORE_MESSAGE("only root can become another user");
  }
}

void root_is_given_up_for_good() {
  skip_unless_root();
  const UnprivilegedUser user("nobody");
  TEST_ASSERT_EQUAL(0, in_a_child([&] {
                      return user.become() && getuid() != 0 && geteuid() != 0 && getgid() != 0 &&
                             setuid(0) != 0 && seteuid(0) != 0 &&
                             prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1;
                    }));
  TEST_ASSERT_EQUAL(0, geteuid());
}

void no_group_of_root_is_left() {
  skip_unless_root();
  const UnprivilegedUser user("nobody");
  TEST_ASSERT_EQUAL(0, in_a_child([&] {
                      const gid_t root = 0;
                      std::vector<gid_t> groups(64);
                      if (setgroups(1, &root) != 0 || !user.become()) {
                        return false;
                      }
                      groups.resize(static_cast<std::size_t>(getgroups(64, groups.data())));
                      return std::none_of(groups.begin(), groups.end(),
                                          [](gid_t group) { return group == 0; });
                    }));
}

/// The real-time thread has locked all memory, now and later.
void memory_can_still_be_had_where_all_of_it_is_locked() {
  skip_unless_root();
  const UnprivilegedUser user("nobody");
  TEST_ASSERT_EQUAL(0, in_a_child([&] {
                      constexpr std::size_t kLarge = 64 << 20;  // above the usual limit
                      if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
                        return true;  // a sanitizer's process is too large for that
                      }
                      return user.become() &&
                             mmap(nullptr, kLarge, PROT_READ | PROT_WRITE,
                                  MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
                    }));
}

void who_is_no_root_cannot_become_another() {
  skip_unless_root();
  const UnprivilegedUser user("nobody");
  TEST_ASSERT_EQUAL(0, in_a_child([&] { return user.become() && is_refused("daemon"); }));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(who_is_not_there_or_is_root_is_refused);
  RUN_TEST(root_is_given_up_for_good);
  RUN_TEST(no_group_of_root_is_left);
  RUN_TEST(memory_can_still_be_had_where_all_of_it_is_locked);
  RUN_TEST(who_is_no_root_cannot_become_another);
  return UNITY_END();
}
