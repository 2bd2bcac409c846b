#pragma once
// Something for each node of each interface.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/frame_layout.hpp"

namespace strainfinger::can {

/// Quick when frames of one interface follow each other, which they mostly do.
template <typename T>
class PerNode {
 public:
  /// What belongs to node 1 .. 63; made when it is asked for first, and stays where it is.
  T& at(std::string_view interface, std::uint8_t node) {
    if (last_ == nullptr || last_->first != interface)
      last_ = &*nodes_.try_emplace(std::string(interface)).first;
    std::unique_ptr<T>& place = last_->second[node - kFirstNode];
    if (!place) place = std::make_unique<T>();
    return *place;
  }

  /// visit(interface, node, thing), by interface, then node.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (const auto& [interface, things] : nodes_)
      for (std::size_t i = 0; i < things.size(); ++i)
        if (things[i]) visit(interface, static_cast<std::uint8_t>(kFirstNode + i), *things[i]);
  }

 private:
  using Nodes =
      std::map<std::string, std::array<std::unique_ptr<T>, kLastNode - kFirstNode + 1>, std::less<>>;
  Nodes nodes_;
  typename Nodes::value_type* last_ = nullptr;
};

}  // namespace strainfinger::can
