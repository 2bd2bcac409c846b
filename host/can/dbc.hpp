#pragma once
// The DBC file of a finger: the frames' tables in the form other people's tools read.

#include <string>
#include <vector>

namespace strainfinger::can {

/// The file's text: the messages between each node FINGER_<node> (1 .. 63, one or more, in any order) and
/// HOST, which of several nodes have their number in their names (CONTACT_2), with units, ranges, comments,
/// named values, and cycle times. A flags field becomes a signal for each of its named bits. GenMsgCycleTime
/// (absent from requests and responses) is the longest time between two frames while there is something to
/// say; GenMsgDelayTime of the frames of touches is the shortest, from the contact rate [Hz]. ASCII only,
/// line ends "\n", the same text for the same arguments.
std::string dbcText(const std::vector<int>& nodes, double contactRate_hz);

}  // namespace strainfinger::can
