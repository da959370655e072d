#include "node/table_admission.hpp"

namespace flexcomp {

Reply TableAdmission::judge(const void* data, std::size_t size, std::uint32_t* counter) const {
  switch (check_signature(key_, data, size, counter)) {
    case Signature::none:
      return Reply::table_not_signed;
    case Signature::wrong:
      return Reply::table_forged;
    case Signature::good:
      break;
  }
  return *counter < highest_ ? Reply::table_older : Reply::ok;
}

}  // namespace flexcomp
