#include "host/config/domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace strainfinger::config {

Domain Domain::evenBetween(double low, double high) {
  Domain domain = between(low, high);
  domain.even_ = true;
  return domain;
}

Domain Domain::oneOf(std::vector<double> choices) {
  const auto [low, high] = std::minmax_element(choices.begin(), choices.end());
  Domain domain = between(*low, *high);
  domain.choices_ = std::move(choices);
  return domain;
}

bool Domain::contains(double value) const {
  const bool inside =
      (lowOpen_ ? value > low_ : value >= low_) && (highOpen_ ? value < high_ : value <= high_);
  if (!inside) return false;
  if (even_) return std::fmod(value, 2) == 0;
  return choices_.empty() || std::find(choices_.begin(), choices_.end(), value) != choices_.end();
}

std::string Domain::text() const {
  if (!choices_.empty()) return fmt::format("one of {}", fmt::join(choices_, ", "));
  if (even_) return fmt::format("even, {} to {}", low_, high_);
  if (lowOpen_) return fmt::format("greater than {}, at most {}", low_, high_);
  if (highOpen_) return fmt::format("at least {}, less than {}", low_, high_);
  return fmt::format("{} to {}", low_, high_);
}

}  // namespace strainfinger::config
