#include "host/can/one_finger.hpp"

#include <fmt/format.h>

#include "common/frames.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {

void OneFinger::watch(const std::string& path, const TextFrame& text) {
  const bool isItsOwn = findFrame(text.frame) != nullptr || decode<RawFrame>(text.frame);
  if (!isItsOwn || fingerNode(text.frame.id) != node_) return;
  if (interface_.empty()) interface_ = text.interface;
  if (text.interface == interface_) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("{}: there is a node {} on {} and one on {}: choose with --interface", path,
                            node_, excerpt(interface_), excerpt(text.interface)));
}

}  // namespace strainfinger::can
