#include "host/can/raw_receiver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/raw_share.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::can {

RawReceiver::RawReceiver(std::uint8_t node, int gauges)
    : node_(node), gauges_(static_cast<std::size_t>(gauges)) {}

/// Zeros' pages may come a page a sample, so that only their order tells what belongs together.
bool RawReceiver::isNext(const Pages& pages, const RawFrame& page) const {
  if (page.page != pages.next || page.page == 0) return false;
  return page.kind == RawKind::kZeros || (page.sample == pages.sample && page.kind == pages.kind);
}

/// Whether the set is whole now. A page that doesn't go on begins anew, if it is a first one.
bool RawReceiver::add(Pages& pages, const RawFrame& page) const {
  if (!isNext(pages, page)) {
    pages = {.sample = page.sample, .kind = page.kind, .codes = {}};
    if (page.page != 0) return false;
  }
  for (const std::uint16_t code : {page.code_0, page.code_1, page.code_2})
    if (pages.codes.size() < gauges_) pages.codes.push_back(code);
  ++pages.next;
  return pages.next == rawPages(static_cast<std::uint32_t>(gauges_));
}

std::optional<RawSet> RawReceiver::take(const CanFrame& frame) {
  if (nodeOf(frame.id, FunctionCode::kRaw) != node_) return std::nullopt;
  const auto page = decode<RawFrame>(frame);
  if (!page) return std::nullopt;
  const int onPage = page->code_2 != 0 ? 3 : page->code_1 != 0 ? 2 : 1;
  heardGauges_ = std::max(heardGauges_, int{kCodesPerPage} * page->page + onPage);
  hasMoreGauges_ |= page->page >= rawPages(static_cast<std::uint32_t>(gauges_));
  if (hasMoreGauges_) return std::nullopt;
  if (page->kind == RawKind::kZeros) {
    if (add(zeroPages_, *page)) zeros_ = zeroPages_.codes;
    return std::nullopt;
  }
  const bool isCutOff = readings_.next != 0 && readings_.codes.size() < gauges_ && !isNext(readings_, *page);
  if (isCutOff) ++incomplete_;
  if (!add(readings_, *page)) return std::nullopt;
  return RawSet{readings_.kind == RawKind::kZeroing, readings_.sample, readings_.codes};
}

void RawReceiver::requireEnoughGauges() const {
  if (sendsAny() && heardGauges_ < static_cast<int>(gauges_))
    throw Failure(
        ExitCode::kMismatch,
        fmt::format("node {}: no whole set of readings: the config has gauges.count = {}, the finger "
                    "sends {}: give this finger's config, -c",
                    node_, gauges_, heardGauges_));
}

void RawReceiver::requireAllGauges() const {
  if (hasMoreGauges_)
    throw Failure(
        ExitCode::kMismatch,
        fmt::format("node {} has more gauges than gauges.count = {}: give its config, -c", node_, gauges_));
}

}  // namespace strainfinger::can
