#include "host/cli/decode_tally.hpp"

#include <fmt/format.h>

#include <numeric>

#include "common/frames.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/remedies.hpp"

namespace strainfinger::cli {
namespace {

/// In the order of SkipReason.
constexpr std::array kSkipNames{"with identifiers that are no finger's",
                                "of other times",
                                "of other nodes",
                                "RAW (`strains` and `replay --recompute` read it)",
                                "of fingers that speak another protocol",
                                "malformed: not the length of such a frame",
                                "with extended (29-bit) identifiers",
                                "remote requests",
                                "of CAN FD",
                                "error frames (reports of the CAN controller)"};
static_assert(kSkipNames.size() == static_cast<std::size_t>(SkipReason::kError) + 1);

/// Not of a finger that speaks another protocol: its frames have no numbers that could be counted.
void summariseNode(const can::NodeCount& node) {
  if (node.protocol.value_or(kProtocolVersion) != kProtocolVersion) return;
  if (node.twoSenders)
    tell("decode: {} node {}: {}: {} frames of touches received, what was lost cannot be told: {}\n",
         node.interface, node.node, can::kTwinText, node.received,
         can::forNode(can::kTwinRemedy, node.interface, node.node));
  else
    tell("decode: {} node {}: {} frames of touches received, {} lost, {} repeated, {} restarts\n",
         node.interface, node.node, node.received, node.lost, node.repeated, node.restarts);
  if (const std::string changes = can::tableChangesText(node); !changes.empty() && !node.twoSenders)
    tell("decode: {} node {}: {}\n", node.interface, node.node, changes);
}

}  // namespace

void DecodeTally::noteForm(const can::LogLine& line) {
  if (form_.empty()) form_ = can::describeForm(line);
}

void DecodeTally::countDecoded(std::string_view interface, const CanFrame& frame) {
  ++decoded_;
  losses_.count(interface, frame);
}

void DecodeTally::countForeign(std::string_view interface, const CanFrame& frame) {
  countSkipped(SkipReason::kForeign);
  losses_.count(interface, frame);
}

void DecodeTally::countWrongLength(const std::string& place, const CanFrame& frame) {
  countSkipped(SkipReason::kWrongLength);
  if (!firstWrongLength_.empty()) return;
  const FrameSpec& spec = can::findFunction(frame.id)->spec;
  firstWrongLength_ = fmt::format("{}: {} of node {} has {} bytes, not {}", place, spec.name,
                                  *nodeOf(frame.id, spec.function), frame.length, spec.length);
}

void DecodeTally::summarise() const {
  const std::uint64_t skipped = std::accumulate(skipped_.begin(), skipped_.end(), std::uint64_t{0});
  tell("decode: {} lines ({}), {} frames decoded, {} others skipped\n", lines_,
       form_.empty() ? "no frames" : form_, decoded_, skipped);
  summariseSkipped();
  if (dropped_ > 0) tell("decode: candump dropped {} frames\n", dropped_);
  for (const can::NodeCount& node : losses_.counts()) summariseNode(node);
}

void DecodeTally::summariseSkipped() const {
  for (std::size_t reason = 0; reason < skipped_.size(); ++reason)
    if (skipped_[reason] > 0) tell("decode: skipped {} {}\n", skipped_[reason], kSkipNames[reason]);
  if (!firstWrongLength_.empty()) tell("decode: {}\n", firstWrongLength_);
}

void DecodeTally::requireGood() const {
  if (unreadable_ > 0)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{} of {} lines could not be read{}", unreadable_, lines_,
                              knowsForm() ? "; the others are decoded"
                                          : ": this is no text of candump; `candump -L` writes one"));
  for (const can::NodeCount& node : losses_.counts()) can::requireOurProtocol(node);
}

}  // namespace strainfinger::cli
