#pragma once
// The DBC file of a finger: the frames' tables in the form other people's tools read.

#include <cstdint>
#include <string>

namespace strainfinger::can {

/// The file's text: the messages between node FINGER_<node> (1 .. 63) and HOST, with units, ranges, comments,
/// named values, and cycle times. A flags field becomes a signal for each of its named bits. GenMsgCycleTime
/// (absent from requests and responses) is the longest time between two frames while there is something to
/// say; GenMsgDelayTime of the frames of touches is the shortest, from the contact rate [Hz]. ASCII only,
/// line ends "\n", the same text for the same arguments.
std::string dbcText(std::uint8_t node, double contactRate_hz);

}  // namespace strainfinger::can
