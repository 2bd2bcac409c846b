#pragma once
// Which values a key may have, as a check and as words.

#include <string>
#include <vector>

namespace strainfinger::config {

/// An interval, with either end open or closed, or a list of choices. NaN and the infinities are in none.
class Domain {
 public:
  static Domain between(double low, double high) { return {low, high, false, false}; }
  static Domain above(double low, double high) { return {low, high, true, false}; }  ///< low excluded
  static Domain below(double low, double high) { return {low, high, false, true}; }  ///< high excluded
  static Domain evenBetween(double low, double high);                                ///< whole even numbers
  static Domain oneOf(std::vector<double> choices);

  bool contains(double value) const;
  std::string text() const;  ///< completes "must be ..."

 private:
  Domain(double low, double high, bool lowOpen, bool highOpen)
      : low_(low), high_(high), lowOpen_(lowOpen), highOpen_(highOpen) {}
  double low_;
  double high_;
  bool lowOpen_;
  bool highOpen_;
  bool even_ = false;
  std::vector<double> choices_;
};

}  // namespace strainfinger::config
