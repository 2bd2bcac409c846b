#include "host/can/touch_receiver.hpp"

#include <tuple>
#include <type_traits>
#include <utility>

#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

/// A member's value in the unit of its field.
template <typename Frame, typename Member>
double physical(const Frame& frame, Member Frame::*member) {
  double value = kNoValue;
  const auto take = [&](const auto& field) {
    if constexpr (std::is_same_v<decltype(field.member), Member Frame::*>)
      if (field.member == member)
        value = toPhysical({field.bits, field.meaning}, rawOf(frame.*member)).value_or(kNoValue);
  };
  std::apply([&take](const auto&... field) { (take(field), ...); }, kLayout<Frame>.fields);
  return value;
}

TouchReport reportOf(const ContactFrame& contact, const ForceFrame& force) {
  return {.angle_deg = physical(contact, &ContactFrame::angle_cdeg),
          .sigmaAngle_deg = physical(contact, &ContactFrame::sigma_angle_cdeg),
          .normal_n = physical(force, &ForceFrame::normal_mN),
          .sigmaNormal_n = physical(force, &ForceFrame::sigma_normal_half_mN),
          .tangential_n = physical(force, &ForceFrame::tangential_mN),
          .sigmaTangential_n = physical(force, &ForceFrame::sigma_tangential_half_mN),
          .quality_percent = physical(contact, &ContactFrame::quality_percent),
          .flags = contact.flags,
          .sequence = contact.sequence};
}

}  // namespace

std::optional<TouchReport> TouchReceiver::take(const CanFrame& frame) {
  if (frame.id == canId(FunctionCode::kContact, node_)) {
    contact_ = decode<ContactFrame>(frame);
    return std::nullopt;
  }
  if (frame.id != canId(FunctionCode::kForce, node_)) return std::nullopt;
  const auto force = decode<ForceFrame>(frame);
  const auto contact = std::exchange(contact_, std::nullopt);
  if (!contact || !force || contact->sequence != force->sequence) return std::nullopt;
  return reportOf(*contact, *force);
}

}  // namespace strainfinger::can
