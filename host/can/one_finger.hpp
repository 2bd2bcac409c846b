#pragma once
// Which finger the frames of a log are of, where their node number alone doesn't say so.

#include <string>

#include "host/can/candump_text.hpp"

namespace strainfinger::can {

/// A node that speaks on several interfaces is several fingers: their readings must not be mixed.
class OneFinger {
 public:
  explicit OneFinger(int node) : node_(node) {}

  /// Takes any frame of the log. Throws Failure(kUsage) at the first of another finger with the node.
  void watch(const std::string& path, const TextFrame& text);

 private:
  int node_;
  std::string interface_;  ///< of its first frame
};

}  // namespace strainfinger::can
