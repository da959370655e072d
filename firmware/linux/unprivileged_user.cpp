#include "linux/unprivileged_user.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <stdexcept>

namespace flexcomp {

UnprivilegedUser::UnprivilegedUser(const std::string& name) : name_(name) {
  if (geteuid() != 0) {
    throw std::runtime_error("--user: only root can become another user");
  }
  const passwd* entry = getpwnam(name.c_str());  // no other thread asks yet
  if (entry == nullptr) {
    throw std::runtime_error("--user: there is no user '" + name + "'");
  }
  if (entry->pw_uid == 0) {
    throw std::runtime_error("--user: '" + name + "' is root");
  }
  user_ = entry->pw_uid;
  group_ = entry->pw_gid;
  // This holds for this thread, and for those that it starts.
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    throw std::runtime_error("--user: the system cannot rule out set-user-ID programs");
  }
}

bool UnprivilegedUser::become() const {
  // Memory that is mapped from now on need not be locked, for only what is no real-time work maps
  // any; and could not be, beyond the little that the system grants a user.
  mlockall(MCL_CURRENT);
  const bool became = initgroups(name_.c_str(), group_) == 0 &&
                      setresgid(group_, group_, group_) == 0 && setresuid(user_, user_, user_) == 0;
  return became && setuid(0) != 0 && setgid(0) != 0;
}

}  // namespace flexcomp
