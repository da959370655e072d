#include <math.h>
#include <string.h>
#include <unity.h>

#include "flexcomp/client.h"

void setUp(void) {}
void tearDown(void) {}

#define PERIOD 0.004
static const double hold = 0.05;
static const double fade = 0.5;
static const double q[6] = {0.1, -0.2, 0.3, -0.4, 0.5, -0.6};
/* What the answers below correct by. */
static const double correction[6] = {0.001, 0.002, 0.003, 0.004, 0.005, 0.006};

/* As cantools and crccheck make them from flexcomp.dbc: all counters are zero. */
static const flexcomp_can_frame_t setpoint_frames[3] = {
    {0x100, 8, false, {0xE2, 0x00, 0x12, 0x7A, 0x00, 0x70, 0x2F, 0xFC}},
    {0x101, 8, false, {0x38, 0x00, 0x36, 0x6E, 0x01, 0xE0, 0x5E, 0xF8}},
    {0x102, 8, false, {0x08, 0x00, 0x5A, 0x62, 0x02, 0x50, 0x8E, 0xF4}}};
static const flexcomp_can_frame_t setpoint_fd = {
    0x108, 32, true, {0x69, 0xA5, 0x00, 0x00, 0x40, 0xE2, 0x01, 0x00, 0xCD, 0xCC, 0xCC,
                      0x3D, 0xCD, 0xCC, 0x4C, 0xBE, 0x9A, 0x99, 0x99, 0x3E, 0xCD, 0xCC,
                      0xCC, 0xBE, 0x00, 0x00, 0x00, 0x3F, 0x9A, 0x99, 0x19, 0xBF}};
static const flexcomp_can_frame_t wrench_frames[2] = {
    {0x110, 8, false, {0x12, 0x50, 0x13, 0x81, 0xB0, 0x86, 0xCC, 0x79}},
    {0x111, 8, false, {0xED, 0x90, 0x01, 0x80, 0x25, 0x80, 0x06, 0x01}}};
static const flexcomp_can_frame_t identity_frames[2] = {
    {0x121, 8, false, {0xEE, 0xF0, 0xDE, 0xBC, 0x9A, 0x18, 0x00, 0x00}},
    {0x122, 8, false, {0x98, 0x70, 0x56, 0x34, 0x12, 0x00, 0x00, 0x00}}};
static const flexcomp_can_frame_t arm_frame = {
    0x120, 8, false, {0xEC, 0x10, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}};
/* In the state active, correcting by `correction`. */
static const flexcomp_can_frame_t answer_frames[7] = {
    {0x200, 8, false, {0x05, 0x80, 0x4A, 0x7B, 0x00, 0x34, 0x39, 0xFC}},
    {0x201, 8, false, {0x75, 0x80, 0xDF, 0x71, 0x01, 0x68, 0x72, 0xF8}},
    {0x202, 8, false, {0xBA, 0x80, 0x74, 0x68, 0x02, 0x9C, 0xAB, 0xF4}},
    {0x204, 8, false, {0xEA, 0x00, 0x12, 0x7A, 0x00, 0x70, 0x2F, 0xFC}},
    {0x205, 8, false, {0x30, 0x00, 0x36, 0x6E, 0x01, 0xE0, 0x5E, 0xF8}},
    {0x206, 8, false, {0x00, 0x00, 0x5A, 0x62, 0x02, 0x50, 0x8E, 0xF4}},
    {0x210, 8, false, {0x94, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20}}};
static const flexcomp_can_frame_t refusal_frame = {
    0x241, 8, false, {0x26, 0x10, 0x10, 0x42, 0x9C, 0x00, 0x00, 0x00}};
static const flexcomp_can_frame_t fault_frame = {
    0x080, 8, false, {0xA2, 0x50, 0x10, 0x57, 0x05, 0x00, 0x00, 0x00}};

static flexcomp_client_t client;
static int64_t now; /* ns */
static uint8_t counter;

static void begin(bool fd) {
  const flexcomp_client_config_t config = {fd, 0x0123456789ABCDEFu, {PERIOD, hold, fade}};
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_init(&client, &config));
  now = 1000000000;
  counter = 0;
}

/* CRC-8 with the polynomial 0x2F, bit by bit, over identifier and payload. */
static void protect(flexcomp_can_frame_t* frame) {
  uint8_t crc = 0xFF;
  for (int i = -1; i < 8; ++i) {
    crc ^= i == -1 ? (uint8_t)frame->id : i == 0 ? (uint8_t)(frame->id >> 8) : frame->data[i];
    for (int bit = 0; bit < 8; ++bit) {
      crc = (uint8_t)((crc & 0x80u) != 0 ? (crc << 1) ^ 0x2F : crc << 1);
    }
  }
  frame->data[0] = (uint8_t)~crc;
}

/* The next answer: `active`, or off with nothing corrected. */
static flexcomp_client_event_t answer(bool active) {
  flexcomp_client_event_t last = FLEXCOMP_CLIENT_NOTHING;
  for (int i = 0; i < 7; ++i) {
    flexcomp_can_frame_t frame = answer_frames[i];
    if (!active && i < 3) {
      memcpy(frame.data, answer_frames[3 + i].data, 8);
    } else if (!active && i == 6) {
      frame.data[7] = 0;
    }
    frame.data[1] = (uint8_t)((frame.data[1] & 0xF0u) | counter);
    protect(&frame);
    last = flexcomp_client_receive(&client, &frame, now);
  }
  counter = (uint8_t)((counter + 1) % 16);
  return last;
}

/* Ends a period; what the drives get beyond `q`. */
static void end_period(double moved[6]) {
  now += 4000000;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_end_period(&client, q, moved));
  for (int i = 0; i < 6; ++i) {
    moved[i] -= q[i];
  }
}

static void follow(int periods) {
  double moved[6];
  for (int i = 0; i < periods; ++i) {
    TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_ANSWER, answer(true));
    end_period(moved);
  }
}

static void assert_frames(const flexcomp_can_frame_t* expected, size_t count,
                          const flexcomp_frames_t* frames) {
  TEST_ASSERT_EQUAL(count, frames->count);
  for (size_t i = 0; i < count; ++i) {
    TEST_ASSERT_EQUAL_HEX32(expected[i].id, frames->frame[i].id);
    TEST_ASSERT_EQUAL(expected[i].fd, frames->frame[i].fd);
    TEST_ASSERT_EQUAL(expected[i].size, frames->frame[i].size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected[i].data, frames->frame[i].data, expected[i].size);
  }
}

static void its_frames_are_those_that_cantools_packs(void) {
  static const double wrench[6] = {440.5, 1370, -635, 0.25, 3, 10.5};
  flexcomp_frames_t frames;
  begin(false);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_setpoint(&client, q, now, &frames));
  assert_frames(setpoint_frames, 3, &frames);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_wrench(&client, wrench, false, now, &frames));
  assert_frames(wrench_frames, 2, &frames);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_identity(&client, &frames));
  assert_frames(identity_frames, 2, &frames);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_command(&client, FLEXCOMP_COMMAND_ARM, &frames));
  assert_frames(&arm_frame, 1, &frames);
  begin(true);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_setpoint(&client, q, 123456000, &frames));
  assert_frames(&setpoint_fd, 1, &frames);
}

static void each_message_has_the_next_counter(void) {
  flexcomp_frames_t frames;
  begin(false);
  for (unsigned i = 0; i < 40; ++i) {
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_setpoint(&client, q, now, &frames));
    for (int part = 0; part < 3; ++part) {
      flexcomp_can_frame_t expected = setpoint_frames[part];
      expected.data[1] = (uint8_t)((expected.data[1] & 0xF0u) | i % 16);
      protect(&expected);
      TEST_ASSERT_EQUAL_HEX8_ARRAY(expected.data, frames.frame[part].data, 8);
    }
  }
}

static void a_wrench_at_the_end_of_the_sensors_range_says_so(void) {
  static const double wrench[6] = {440.5, 1370, -635, 0.25, 3, 10.5};
  flexcomp_frames_t plain;
  flexcomp_frames_t saturated;
  begin(false);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_wrench(&client, wrench, false, now, &plain));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_wrench(&client, wrench, true, now, &saturated));
  TEST_ASSERT_EQUAL_HEX8(plain.frame[0].data[7] ^ 0x80u, saturated.frame[0].data[7]);
}

static void an_answer_moves_the_robot_and_can_be_read(void) {
  begin(false);
  follow(3);
  flexcomp_answer_t read;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_answer(&client, &read));
  TEST_ASSERT_EQUAL(FLEXCOMP_STATE_ACTIVE, read.state);
  TEST_ASSERT_EQUAL_HEX32(0, read.status);
  double moved[6];
  answer(true);
  end_period(moved);
  for (int i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, q[i] + correction[i], read.corrected[i]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, q[i], read.uncorrected[i]);
    TEST_ASSERT_DOUBLE_WITHIN(2e-7, correction[i], moved[i]);
  }
}

static void a_frame_with_one_wrong_bit_is_no_answer(void) {
  for (unsigned bit = 0; bit < 64; ++bit) {
    begin(false);
    for (int i = 0; i < 7; ++i) {
      flexcomp_can_frame_t frame = answer_frames[i];
      frame.data[bit / 8] ^= i == 4 ? (uint8_t)(1u << bit % 8) : 0;
      TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_NOTHING, flexcomp_client_receive(&client, &frame, now));
    }
  }
}

static void a_frame_that_claims_more_than_there_is_is_nothing(void) {
  begin(false);
  flexcomp_can_frame_t frame = setpoint_fd;
  frame.size = 255;
  TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_NOTHING, flexcomp_client_receive(&client, &frame, now));
}

static void without_answers_it_holds_then_fades_without_a_jump(void) {
  begin(false);
  follow(10);
  double last = correction[0];
  double moved[6];
  for (int i = 1; i <= 200; ++i) {
    end_period(moved);
    const double beyond = (i * PERIOD - hold) / fade;
    const double share = beyond <= 0 ? 1 : beyond >= 1 ? 0 : 1 - beyond;
    TEST_ASSERT_DOUBLE_WITHIN(2e-7, share * correction[0], moved[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1.01 * correction[0] * PERIOD / fade, last, moved[0]);
    last = moved[0];
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, last);
}

static void a_short_gap_is_bridged(void) {
  begin(false);
  follow(10);
  double moved[6];
  for (int i = 0; i < 12; ++i) {
    end_period(moved);
    TEST_ASSERT_DOUBLE_WITHIN(2e-7, correction[5], moved[5]);
  }
  follow(1);
  TEST_ASSERT_FALSE(flexcomp_client_is_lost(&client));
}

static void once_lost_it_stays_at_zero_until_the_compensator_has_been_off(void) {
  begin(false);
  follow(10);
  double moved[6];
  for (int i = 0; i < 200; ++i) {
    end_period(moved);
  }
  TEST_ASSERT_TRUE(flexcomp_client_is_lost(&client));
  for (int i = 0; i < 20; ++i) {
    answer(true);
    end_period(moved);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, moved[2]);
  }
  answer(false);
  end_period(moved);
  TEST_ASSERT_FALSE(flexcomp_client_is_lost(&client));
  answer(true);
  end_period(moved);
  TEST_ASSERT_DOUBLE_WITHIN(2e-7, correction[2], moved[2]);
}

static void a_compensator_that_is_suddenly_off_is_faded_out(void) {
  begin(false);
  follow(10);
  double last = correction[0];
  double moved[6];
  for (int i = 0; i < 200; ++i) {
    answer(false);
    end_period(moved);
    TEST_ASSERT_DOUBLE_WITHIN(1.01 * correction[0] * PERIOD / fade, last, moved[0]);
    last = moved[0];
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, last);
}

static void a_refusal_has_words(void) {
  begin(false);
  TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_REPLY, flexcomp_client_receive(&client, &refusal_frame, now));
  flexcomp_command_reply_t reply;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_reply(&client, &reply));
  TEST_ASSERT_EQUAL(FLEXCOMP_COMMAND_ARM, reply.command);
  TEST_ASSERT_EQUAL_STRING("the sender works with another robot, tool or payload",
                           flexcomp_describe_reply(reply.reply));
  TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.25, reply.largest_gain);
}

static void a_fault_is_told(void) {
  begin(false);
  TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_FAULT, flexcomp_client_receive(&client, &fault_frame, now));
  flexcomp_fault_t fault;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_fault(&client, &fault));
  TEST_ASSERT_EQUAL_HEX16(0x7105, fault.code);
  TEST_ASSERT_TRUE(fault.active);
  TEST_ASSERT_EQUAL(42, fault.detail);
  TEST_ASSERT_EQUAL_STRING("ticks late", flexcomp_describe_node_bit(1u << 5));
}

static void a_setpoint_that_is_not_finite_moves_nothing(void) {
  begin(false);
  const double bad[6] = {0, 0, NAN, 0, 0, 0};
  double drives[6] = {7, 7, 7, 7, 7, 7};
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_client_end_period(&client, bad, drives));
  TEST_ASSERT_EQUAL_DOUBLE(7, drives[0]);
}

static void what_cannot_be_is_refused(void) {
  const flexcomp_result_t bad = FLEXCOMP_BAD_ARGUMENT;
  flexcomp_client_config_t config = {false, 1, {PERIOD, hold, fade}};
  flexcomp_frames_t frames;
  begin(false);
  TEST_ASSERT_EQUAL(bad, flexcomp_client_init(NULL, &config));
  TEST_ASSERT_EQUAL(bad, flexcomp_client_setpoint(&client, NULL, now, &frames));
  TEST_ASSERT_EQUAL(bad, flexcomp_client_wrench(&client, q, false, now, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_client_identity(NULL, &frames));
  TEST_ASSERT_EQUAL(bad, flexcomp_client_command(&client, (flexcomp_command_t)0, &frames));
  TEST_ASSERT_EQUAL(bad, flexcomp_client_answer(&client, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_CLIENT_NOTHING, flexcomp_client_receive(&client, NULL, now));
  static const double times[4][3] = {{0, 0.1, 1}, {NAN, 0.1, 1}, {PERIOD, -1, 1}, {PERIOD, 1, 0}};
  for (int i = 0; i < 4; ++i) {
    config.follower = (flexcomp_follower_config_t){times[i][0], times[i][1], times[i][2]};
    TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG, flexcomp_client_init(&client, &config));
  }
}

static void a_follower_serves_another_transport(void) {
  const flexcomp_follower_config_t config = {PERIOD, 0, 2 * PERIOD};
  flexcomp_follower_t follower;
  double moved[6];
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_follower_init(&follower, &config));
  flexcomp_follower_take(&follower, correction, false);
  flexcomp_follower_end_period(&follower, moved);
  TEST_ASSERT_EQUAL_DOUBLE(correction[3], moved[3]);
  flexcomp_follower_end_period(&follower, moved);
  TEST_ASSERT_TRUE(flexcomp_follower_is_lost(&follower));
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, correction[3] / 2, moved[3]);
  flexcomp_follower_end_period(&follower, moved);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, moved[3]);
}

int main(void) {
  UNITY_BEGIN();
  RUN_TEST(its_frames_are_those_that_cantools_packs);
  RUN_TEST(each_message_has_the_next_counter);
  RUN_TEST(a_wrench_at_the_end_of_the_sensors_range_says_so);
  RUN_TEST(an_answer_moves_the_robot_and_can_be_read);
  RUN_TEST(a_frame_with_one_wrong_bit_is_no_answer);
  RUN_TEST(a_frame_that_claims_more_than_there_is_is_nothing);
  RUN_TEST(without_answers_it_holds_then_fades_without_a_jump);
  RUN_TEST(a_short_gap_is_bridged);
  RUN_TEST(once_lost_it_stays_at_zero_until_the_compensator_has_been_off);
  RUN_TEST(a_compensator_that_is_suddenly_off_is_faded_out);
  RUN_TEST(a_refusal_has_words);
  RUN_TEST(a_fault_is_told);
  RUN_TEST(a_setpoint_that_is_not_finite_moves_nothing);
  RUN_TEST(what_cannot_be_is_refused);
  RUN_TEST(a_follower_serves_another_transport);
  return UNITY_END();
}
