#include "host/can/touch_receiver.hpp"

#include <tuple>
#include <type_traits>
#include <utility>

#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

/// The field of a member.
template <typename Frame, typename Member>
FieldSpec fieldOf(Member Frame::*member) {
  FieldSpec found{};
  const auto take = [&](const auto& field) {
    if constexpr (std::is_same_v<decltype(field.member), Member Frame::*>)
      if (field.member == member) found = {field.bits, field.meaning};
  };
  std::apply([&take](const auto&... field) { (take(field), ...); }, kLayout<Frame>.fields);
  return found;
}

/// A member's value in the unit of its field.
template <typename Frame, typename Member>
double physical(const Frame& frame, Member Frame::*member) {
  return toPhysical(fieldOf(member), rawOf(frame.*member)).value_or(kNoValue);
}

/// The largest one.
template <typename Frame, typename Member>
double largest(Member Frame::*member) {
  const FieldSpec field = fieldOf(member);
  return toPhysical(field, maxRaw(field.bits)).value_or(kNoValue);
}

ContactReport reportOf(const ContactFrame& contact, const ForceFrame& force) {
  return {.angle_deg = physical(contact, &ContactFrame::angle_cdeg),
          .sigmaAngle_deg = physical(contact, &ContactFrame::sigma_angle_cdeg),
          .normal_n = physical(force, &ForceFrame::normal_mN),
          .sigmaNormal_n = physical(force, &ForceFrame::sigma_normal_half_mN),
          .tangential_n = physical(force, &ForceFrame::tangential_mN),
          .sigmaTangential_n = physical(force, &ForceFrame::sigma_tangential_half_mN),
          .quality_percent = physical(contact, &ContactFrame::quality_percent),
          .alternative_deg = physical(contact, &ContactFrame::alternative_deg)};
}

}  // namespace

const LargestValues& largestValues() {
  static const LargestValues values{.normal_n = largest(&ForceFrame::normal_mN),
                                    .tangential_n = largest(&ForceFrame::tangential_mN),
                                    .sigmaAngle_deg = largest(&ContactFrame::sigma_angle_cdeg),
                                    .alternative_deg = largest(&ContactFrame::alternative_deg),
                                    .sigmaNormal_n = largest(&ForceFrame::sigma_normal_half_mN),
                                    .sigmaTangential_n = largest(&ForceFrame::sigma_tangential_half_mN),
                                    .width_m = largest(&PatchFrame::width_um),
                                    .sigmaWidth_m = largest(&PatchFrame::sigma_width_um),
                                    .chi = largest(&PatchFrame::chi_sixteenths)};
  return values;
}

bool TouchReceiver::Touch::isComplete() const {
  return contact && force && patch && ((patch->contacts < 2 && !followsSecond) || (contact2 && force2));
}

/// Where the PATCH that would say so was lost, its frames do.
bool TouchReceiver::Touch::hasSecond() const {
  if (patch) return patch->contacts >= 2;
  return (contact2 && contact2->flags.has(FingerFlag::kContact)) ||
         (force2 && force2->flags.has(FingerFlag::kContact));
}

TouchReport TouchReceiver::Touch::report() const {
  const PatchFrame known = patch.value_or(PatchFrame{});
  TouchReport report{reportOf(*contact, force.value_or(ForceFrame{}))};
  report.width_m = physical(known, &PatchFrame::width_um);
  report.sigmaWidth_m = physical(known, &PatchFrame::sigma_width_um);
  report.chi = physical(known, &PatchFrame::chi_sixteenths);
  if (patch) report.contacts = patch->contacts;
  const ContactReport other = reportOf(contact2.value_or(Contact2Frame{}), force2.value_or(Force2Frame{}));
  if (hasSecond())
    report.second = other;
  else if (contact2 || force2)
    report.secondsEnd = other;
  report.flags = contact->flags;
  report.sequence = contact->sequence;
  return report;
}

/// Whether the frame is this one, of our node.
template <typename Frame>
bool TouchReceiver::keep(const CanFrame& frame, std::optional<Frame>& place) const {
  if (frame.id != canId(kLayout<Frame>.spec.function, node_)) return false;
  const auto values = decode<Frame>(frame);
  if (values && touch_.contact && values->sequence == touch_.contact->sequence) place = values;
  return true;
}

std::optional<TouchReport> TouchReceiver::take(const CanFrame& frame) {
  if (frame.id == canId(FunctionCode::kContact, node_)) {
    if (touch_.contact) hadSecond_ = touch_.hasSecond();
    touch_ = {.contact = decode<ContactFrame>(frame), .followsSecond = hadSecond_};
    return std::nullopt;
  }
  const bool kept = keep(frame, touch_.force) || keep(frame, touch_.patch) || keep(frame, touch_.contact2) ||
                    keep(frame, touch_.force2);
  if (!kept || !touch_.isComplete()) return std::nullopt;
  return finish();
}

std::optional<TouchReport> TouchReceiver::giveUp() {
  if (!touch_.contact) return std::nullopt;
  return finish();
}

TouchReport TouchReceiver::finish() {
  hadSecond_ = touch_.hasSecond();
  return std::exchange(touch_, {}).report();
}

}  // namespace strainfinger::can
