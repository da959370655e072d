#pragma once

#include <sys/types.h>

#include <string>

namespace flexcomp {

/// Whom a process that was started as root becomes once it has what it needs root for.
class UnprivilegedUser {
 public:
  /// Closes the way back to root through set-user-ID programs: to be made before any thread is
  /// started. Throws std::runtime_error if there is no such user, it is root, or this process is
  /// not.
  explicit UnprivilegedUser(const std::string& name);

  /// Gives up root for good, in all threads: user, groups and capabilities. Scheduling, locked
  /// memory and open sockets stay; memory that is mapped later is not locked. False if the system
  /// refuses; the process must not go on then.
  bool become() const;

 private:
  std::string name_;
  uid_t user_ = 0;
  gid_t group_ = 0;
};

}  // namespace flexcomp
