#include "flexcomp/client.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "client/correction_follower.hpp"
#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "node/node_status.hpp"
#include "node/reply.hpp"

namespace {

using flexcomp::CorrectionFollower;
using Correction = CorrectionFollower::Correction;
using Angles = Eigen::Map<const Correction>;

/// All that a client keeps.
class Client {
 public:
  explicit Client(const flexcomp_client_config_t& config)
      : follower(config.follower.period, config.follower.hold_time, config.follower.fade_time),
        model_hash(config.model_hash),
        encoder(config.fd) {}

  flexcomp_client_event_t take(const flexcomp::Message& message);

  CorrectionFollower follower;
  std::uint64_t model_hash;
  flexcomp::CanEncoder encoder;
  flexcomp::CanDecoder decoder;
  flexcomp_answer_t answer{};
  flexcomp_command_reply_t reply{};
  flexcomp_fault_t fault{};

 private:
  flexcomp_client_event_t take(const flexcomp::CorrectedMessage& corrected);
};

static_assert(sizeof(CorrectionFollower) <= FLEXCOMP_FOLLOWER_BYTES, "room for the object");
static_assert(alignof(CorrectionFollower) <= alignof(flexcomp_follower_t), "aligned for it");
static_assert(sizeof(Client) <= FLEXCOMP_CLIENT_BYTES, "room for the object");
static_assert(alignof(Client) <= alignof(flexcomp_client_t), "aligned for the object");
static_assert(FLEXCOMP_COMMAND_ARM == static_cast<int>(flexcomp::Command::arm) &&
                  FLEXCOMP_COMMAND_DISARM == static_cast<int>(flexcomp::Command::disarm) &&
                  FLEXCOMP_COMMAND_RESET == static_cast<int>(flexcomp::Command::reset) &&
                  FLEXCOMP_COMMAND_REPORT == static_cast<int>(flexcomp::Command::report),
              "the same numbers");

CorrectionFollower* object(flexcomp_follower_t* from) {
  return std::launder(reinterpret_cast<CorrectionFollower*>(from->bytes));
}

const CorrectionFollower* object(const flexcomp_follower_t* from) {
  return std::launder(reinterpret_cast<const CorrectionFollower*>(from->bytes));
}

Client* object(flexcomp_client_t* from) {
  return std::launder(reinterpret_cast<Client*>(from->bytes));
}

const Client* object(const flexcomp_client_t* from) {
  return std::launder(reinterpret_cast<const Client*>(from->bytes));
}

flexcomp_result_t check(const flexcomp_follower_config_t& config) {
  const bool is_finite = std::isfinite(config.period) && std::isfinite(config.hold_time) &&
                         std::isfinite(config.fade_time);
  const bool in_range = config.period > 0 && config.hold_time >= 0 && config.fade_time > 0;
  return is_finite && in_range ? FLEXCOMP_OK : FLEXCOMP_BAD_CONFIG;
}

/// The frames of a message as C has them.
flexcomp_result_t give(flexcomp_client_t* client, const flexcomp::Message& message,
                       flexcomp_frames_t* frames) {
  constexpr std::size_t kRoom = sizeof(frames->frame) / sizeof(frames->frame[0]);
  const flexcomp::FrameList& list = object(client)->encoder.encode(message);
  frames->count = std::min(list.count, kRoom);
  for (std::size_t i = 0; i < frames->count; ++i) {
    const flexcomp::CanFrame& from = list.frames[i];
    flexcomp_can_frame_t* to = &frames->frame[i];
    to->id = from.id;
    to->size = from.size;
    to->fd = from.fd;
    std::copy(from.data.begin(), from.data.end(), to->data);
  }
  return FLEXCOMP_OK;
}

/// Copies what a client has kept of one kind.
template <typename Kind>
flexcomp_result_t give(const flexcomp_client_t* client, Kind Client::*kept, Kind* to) {
  if (client == nullptr || to == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  *to = object(client)->*kept;
  return FLEXCOMP_OK;
}

flexcomp_client_event_t Client::take(const flexcomp::CorrectedMessage& corrected) {
  std::copy(corrected.corrected.begin(), corrected.corrected.end(), answer.corrected);
  std::copy(corrected.uncorrected.begin(), corrected.uncorrected.end(), answer.uncorrected);
  answer.status = corrected.status;
  answer.node_status = corrected.node_status;
  answer.state = static_cast<flexcomp_state_t>(corrected.state);
  const bool off = answer.state == FLEXCOMP_STATE_OFF || answer.state == FLEXCOMP_STATE_LATCHED;
  follower.take(Angles(answer.corrected) - Angles(answer.uncorrected), off);
  return FLEXCOMP_CLIENT_ANSWER;
}

flexcomp_client_event_t Client::take(const flexcomp::Message& message) {
  if (const auto* corrected = std::get_if<flexcomp::CorrectedMessage>(&message)) {
    return take(*corrected);
  }
  if (const auto* replied = std::get_if<flexcomp::CommandReplyMessage>(&message)) {
    reply = {static_cast<flexcomp_command_t>(replied->command), replied->reply,
             replied->largest_gain};
    return FLEXCOMP_CLIENT_REPLY;
  }
  if (const auto* told = std::get_if<flexcomp::FaultMessage>(&message)) {
    fault = {told->code, told->active, told->detail};
    return FLEXCOMP_CLIENT_FAULT;
  }
  return std::holds_alternative<flexcomp::HeartbeatMessage>(message) ? FLEXCOMP_CLIENT_HEARTBEAT
                                                                     : FLEXCOMP_CLIENT_NOTHING;
}

}  // namespace

flexcomp_result_t flexcomp_follower_init(flexcomp_follower_t* follower,
                                         const flexcomp_follower_config_t* config) {
  if (follower == nullptr || config == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  new (follower->bytes) CorrectionFollower(config->period, config->hold_time, config->fade_time);
  return check(*config);
}

void flexcomp_follower_take(flexcomp_follower_t* follower, const double correction[FLEXCOMP_JOINTS],
                            bool off) {
  if (follower != nullptr && correction != nullptr) {
    object(follower)->take(Angles(correction), off);
  }
}

void flexcomp_follower_end_period(flexcomp_follower_t* follower,
                                  double correction[FLEXCOMP_JOINTS]) {
  if (follower != nullptr && correction != nullptr) {
    object(follower)->end_period();
    Eigen::Map<Correction>(correction, FLEXCOMP_JOINTS) = object(follower)->correction();
  }
}

bool flexcomp_follower_is_lost(const flexcomp_follower_t* follower) {
  return follower != nullptr && object(follower)->is_lost();
}

flexcomp_result_t flexcomp_client_init(flexcomp_client_t* client,
                                       const flexcomp_client_config_t* config) {
  if (client == nullptr || config == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  new (client->bytes) Client(*config);
  return check(config->follower);
}

flexcomp_result_t flexcomp_client_identity(flexcomp_client_t* client, flexcomp_frames_t* frames) {
  if (client == nullptr || frames == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  return give(client,
              flexcomp::IdentityMessage{object(client)->model_hash, flexcomp::WrenchFrame::base},
              frames);
}

flexcomp_result_t flexcomp_client_wrench(flexcomp_client_t* client, const double wrench[6],
                                         bool saturated, int64_t now, flexcomp_frames_t* frames) {
  if (client == nullptr || wrench == nullptr || frames == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::WrenchMessage message{now, {}, saturated};
  std::copy_n(wrench, message.wrench.size(), message.wrench.begin());
  return give(client, message, frames);
}

flexcomp_result_t flexcomp_client_setpoint(flexcomp_client_t* client,
                                           const double setpoint[FLEXCOMP_JOINTS], int64_t now,
                                           flexcomp_frames_t* frames) {
  if (client == nullptr || setpoint == nullptr || frames == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::SetpointMessage message{now, {}};
  std::copy_n(setpoint, message.q.size(), message.q.begin());
  return give(client, message, frames);
}

flexcomp_result_t flexcomp_client_command(flexcomp_client_t* client, flexcomp_command_t command,
                                          flexcomp_frames_t* frames) {
  if (client == nullptr || frames == nullptr || command < FLEXCOMP_COMMAND_ARM ||
      command > FLEXCOMP_COMMAND_REPORT) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  return give(client, flexcomp::CommandMessage{static_cast<flexcomp::Command>(command)}, frames);
}

flexcomp_client_event_t flexcomp_client_receive(flexcomp_client_t* client,
                                                const flexcomp_can_frame_t* frame, int64_t now) {
  flexcomp::CanFrame taken;
  if (client == nullptr || frame == nullptr || frame->size > taken.data.size()) {
    return FLEXCOMP_CLIENT_NOTHING;
  }
  taken.id = frame->id;
  taken.size = frame->size;
  taken.fd = frame->fd;
  std::copy_n(frame->data, frame->size, taken.data.begin());
  return object(client)->take(object(client)->decoder.decode(taken, now));
}

flexcomp_result_t flexcomp_client_answer(const flexcomp_client_t* client,
                                         flexcomp_answer_t* answer) {
  return give(client, &Client::answer, answer);
}

flexcomp_result_t flexcomp_client_reply(const flexcomp_client_t* client,
                                        flexcomp_command_reply_t* reply) {
  return give(client, &Client::reply, reply);
}

flexcomp_result_t flexcomp_client_fault(const flexcomp_client_t* client, flexcomp_fault_t* fault) {
  return give(client, &Client::fault, fault);
}

flexcomp_result_t flexcomp_client_end_period(flexcomp_client_t* client,
                                             const double setpoint[FLEXCOMP_JOINTS],
                                             double drives[FLEXCOMP_JOINTS]) {
  if (client == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  CorrectionFollower* follower = &object(client)->follower;
  follower->end_period();
  if (setpoint == nullptr || drives == nullptr || !Angles(setpoint).allFinite()) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  Eigen::Map<Correction>(drives, FLEXCOMP_JOINTS) = Angles(setpoint) + follower->correction();
  return FLEXCOMP_OK;
}

bool flexcomp_client_is_lost(const flexcomp_client_t* client) {
  return client != nullptr && object(client)->follower.is_lost();
}

const char* flexcomp_describe_reply(uint8_t reply) { return flexcomp::describe_reply(reply); }

const char* flexcomp_describe_node_bit(uint16_t bit) {
  return flexcomp::describe(static_cast<flexcomp::NodeBit>(bit));
}
