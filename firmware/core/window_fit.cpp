#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

bool refine(const FitTable& rows, int mirrorSign, WindowFit& fit) {
  constexpr int kMaxSteps = 8;
  takeStep(rows, fit);
  for (int count = 1; count < kMaxSteps && !fit.converged(); ++count) {
    follow(fit, mirrorSign);
    takeStep(rows, fit);
  }
  return fit.converged();
}

}  // namespace strainfinger::firmware
