#include "node/reply.hpp"

#include "flexcomp/status.hpp"
#include "messages/messages.hpp"

namespace flexcomp {

const char* describe_reply(std::uint8_t reply) {
  switch (static_cast<Reply>(reply)) {
    case Reply::ok:
      return "ok";
    case Reply::robot_unknown:
      return "the sender has not said which robot it works with";
    case Reply::other_robot:
      return "the sender works with another robot, tool or payload";
    case Reply::wrong_wrench_frame:
      return "the wrench is not in the base frame";
    case Reply::fault_present:
      return "a fault lasts until reset";
    case Reply::transfer_refused:
      return "no room for the table, or another is being checked";
    case Reply::transfer_out_of_order:
      return "a part of the table is missing";
    case Reply::transfer_crc:
      return "the table was damaged on its way";
    case Reply::transfer_not_checked:
      return "the table was not checked in time";
    case Reply::table_not_signed:
      return "the table is not signed (flexcomp table sign)";
    case Reply::table_forged:
      return "the table's signature is of another key or of other content";
    case Reply::table_older:
      return "the table is older than one that has run";
  }
  return describe(static_cast<Result>(reply));
}

}  // namespace flexcomp
