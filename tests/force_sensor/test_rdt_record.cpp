#include <cstring>
#include <string>

#include "force_sensor/rdt_record.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

/// As a sensor sends it: 1, 2, status 0x80010000, then 1, -1, 2000000, -2000000, 2^31 - 1, -2^31.
const std::string kDatagram(
    "\x00\x00\x00\x01\x00\x00\x00\x02\x80\x01\x00\x00"
    "\x00\x00\x00\x01\xff\xff\xff\xff\x00\x1e\x84\x80\xff\xe1\x7b\x80\x7f\xff\xff\xff\x80\x00\x00"
    "\x00",
    36);

void a_record_is_read_with_the_highest_byte_first() {
  RdtRecord record;
  TEST_ASSERT_TRUE(read_record(kDatagram, &record));
  TEST_ASSERT_EQUAL_UINT32(1, record.sequence);
  TEST_ASSERT_EQUAL_UINT32(2, record.sample);
  TEST_ASSERT_EQUAL_HEX32(0x80010000, record.status);
  const std::array<std::int32_t, 6> expected = {1, -1, 2000000, -2000000, INT32_MAX, INT32_MIN};
  TEST_ASSERT_EQUAL_INT32_ARRAY(expected.data(), record.load.data(), 6);
}

void a_datagram_of_another_size_is_no_record() {
  RdtRecord record;
  for (std::size_t size = 0; size < kDatagram.size(); ++size) {
    TEST_ASSERT_FALSE(read_record(kDatagram.substr(0, size), &record));
  }
  TEST_ASSERT_FALSE(read_record(kDatagram + '\0', &record));
  TEST_ASSERT_FALSE(read_record(kDatagram + kDatagram, &record));
}

void a_request_is_as_the_manual_has_it() {
  TEST_ASSERT_EQUAL_MEMORY("\x12\x34\x00\x02\x00\x00\x00\x00",
                           rdt_request(RdtCommand::stream).data(), 8);
  TEST_ASSERT_EQUAL_MEMORY("\x12\x34\x00\x00\x00\x00\x00\x00", rdt_request(RdtCommand::stop).data(),
                           8);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_record_is_read_with_the_highest_byte_first);
  RUN_TEST(a_datagram_of_another_size_is_no_record);
  RUN_TEST(a_request_is_as_the_manual_has_it);
  return UNITY_END();
}
