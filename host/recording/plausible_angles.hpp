#pragma once

#include "model/chain.hpp"
#include "recording/recording.hpp"

namespace flexcomp::recording {

/// A recording of a robot. Throws as `read_recording` does, and with file, line, column and unit at
/// the first joint angle that lies more than half a turn outside its joint's limits, or the first
/// travel of a joint that slides that lies outside by more than the whole travel: they are of
/// another robot, in degrees or in millimetres. A limit in a model may be a little off, so less is
/// let pass.
Recording read_recording_of(const model::Chain& chain, const std::filesystem::path& path);

/// A program that a robot is to run: as above, but nothing outside the limits is let pass in q_cmd,
/// because the core refuses such setpoints.
Recording read_program_of(const model::Chain& chain, const std::filesystem::path& path);

}  // namespace flexcomp::recording
