#pragma once

#include <cstdint>

#include "node/slcan_node.hpp"

/// The functions that the firmware needs of a board. Each board has a folder with `board.cpp`,
/// which defines these and its interrupt vectors (section .vectors.board), and `memory.ld`.
namespace flexcomp::cortex_m7::board {

/// Hz, of the processor once `start` has returned.
std::uint32_t clock_frequency();

/// Sets up clock and serial line. From then on interrupts put what arrives into `received`.
void start(SlcanNode::Bytes* received, SlcanNode::Bytes* to_send);

/// Time (ns) since the last call, from a counter that runs by itself: a step that took long must
/// not look short. To be called at least once a second.
std::int64_t elapsed();

/// There is something in `to_send`: to be sent by interrupts, without waiting here.
void wake_sender();

/// A watchdog that ends in the handler of faults, and if that hangs in a reset, unless it is fed
/// every `milliseconds`.
void start_watchdog(std::uint32_t milliseconds);
void feed_watchdog();

}  // namespace flexcomp::cortex_m7::board
