#include "host/shape/touch_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/shape/quantiles.hpp"

namespace strainfinger::shape {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kStepsPerPitch = 8;
constexpr double kApart = 3;         ///< sigmas: an end of the search farther away is another touch
constexpr double kFar = 4.5;         ///< sigmas of all places: farther than any that are normal
constexpr double kSame = 0.1;        ///< sigmas: nearer is the same end of two searches
constexpr double kSameValley = 1.5;  ///< sigmas: nearer to a place of a valley lies in it
constexpr std::size_t kEnough = 5;   ///< places: fewer have no spread
constexpr std::size_t kStarts = 8;
constexpr double kNear = 0.75;  ///< of what the best explains: the grid alone costs a few per cent

struct Candidate {
  TouchFit fit;
  double penalised;
};

/// Chi squared, and the sigmas by which a touch breaks the law of friction or is narrower than a line.
double penalised(const TouchFit& fit, double friction) {
  const double excess = std::abs(fit.touch.tangential_n_per_m) - friction * fit.touch.normal_n_per_m;
  const double sliding = std::max(0.0, excess) / std::sqrt(fit.covariance(2, 2));
  const double narrow = std::max(0.0, -fit.touch.moment_rad2) / std::sqrt(fit.covariance(3, 3));
  return fit.chiSquared + sliding * sliding + narrow * narrow;
}

/// All places of all valleys within kPlausible of the best one's end; chi squared with the valley's penalty.
PlausibleTouches placesOf(const TouchModel& model, const VectorXd& strains, double noise,
                          const std::vector<Candidate>& candidates) {
  PlausibleTouches all{{}, true};
  for (const Candidate& candidate : candidates) {
    if (!(candidate.penalised < candidates[0].penalised + kPlausible)) break;
    const bool isSeen = std::ranges::any_of(all.touches, [&](const PlausibleTouch& place) {
      return !areApart(candidate.fit, place.touch, kSameValley);
    });
    if (isSeen) continue;
    PlausibleTouches valley = plausibleTouches(model, strains, noise, candidate.fit);
    for (PlausibleTouch& place : valley.touches) {
      place.chiSquared += candidate.penalised - candidate.fit.chiSquared;
      all.touches.push_back(place);
    }
    all.areAll &= valley.areAll;
  }
  return all;
}

/// Around a touch, each weighing its likelihood, exp(-chi squared / 2), and its area.
Eigen::Matrix4d covarianceAround(const Touch& touch, const std::vector<PlausibleTouch>& places) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  double weights = 0;
  for (const PlausibleTouch& place : places) {
    const double weight = place.area * std::exp((places[0].chiSquared - place.chiSquared) / 2);
    const Eigen::Vector4d offset = difference(place.touch, touch);
    sum += weight * offset * offset.transpose();
    sum.block<2, 2>(1, 1) += weight * place.loadCovariance;
    weights += weight;
  }
  return sum / weights;
}

/// Touches that fit about as well as the best one but are another: other ends of the search, and what of a
/// valley is farther away than the sigmas of all let expect; all of what is known of a valley that wasn't
/// followed to its end.
std::vector<Touch> rivalsOf(const std::vector<Candidate>& candidates, const PlausibleTouches& places,
                            const TouchFit& mixed) {
  const double most = candidates[0].penalised + kRival;
  std::vector<Touch> rivals;
  for (const Candidate& other : candidates)
    if (other.penalised < most && areApart(candidates[0].fit, other.fit.touch, kApart))
      rivals.push_back(other.fit.touch);
  for (const PlausibleTouch& place : places.touches)
    if (place.chiSquared < most && (!places.areAll || areApart(mixed, place.touch, kFar)))
      rivals.push_back(place.touch);
  return rivals;
}

/// The covariance, enlarged so that limits of 95 % on either side hold the rivals.
Eigen::Matrix4d holding(const std::vector<Touch>& rivals, const TouchFit& mixed) {
  const Eigen::Array4d sigma = mixed.covariance.diagonal().array().sqrt();
  Eigen::Array4d reach = sigma;
  for (const Touch& rival : rivals)
    reach = reach.max(difference(rival, mixed.touch).array().abs() / kOneSided95);
  const Eigen::Vector4d scale = reach / sigma;
  return scale.asDiagonal() * mixed.covariance * scale.asDiagonal();
}

}  // namespace

/// A place to begin, and how much of the readings' sum of squares it explains.
struct TouchSearch::Start {
  double explained = 0;
  Touch touch;
};

TouchSearch::TouchSearch(const TouchModel& model, double friction) : model_(model), friction_(friction) {
  for (const double width : {0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0})  // in depths of the gauges
    moments_rad2_.push_back(std::min(momentOfWidth(width * model.depth()), TouchModel::kMostMoment_rad2));
  const Index angles = model.gauges() * kStepsPerPitch;
  for (Index i = 0; i < angles; ++i)
    angles_rad_.push_back(model.gaugeAngle_rad(0) +
                          2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(angles));
  const auto moments = static_cast<Index>(moments_rad2_.size());
  normal_.resize(model.gauges(), moments * angles);
  tangential_.resize(model.gauges(), moments * angles);
  for (Index place = 0; place < moments * angles; ++place) {
    const Touch touch{angles_rad_[static_cast<std::size_t>(place % angles)], 1, 1,
                      moments_rad2_[static_cast<std::size_t>(place / angles)]};
    const TouchStrains response = model_.respond(Profile::kEllipse, touch);
    normal_.col(place) = response.slopes.col(1);
    tangential_.col(place) = response.slopes.col(2);
  }
  normalSquare_ = normal_.colwise().squaredNorm();
  tangentialSquare_ = tangential_.colwise().squaredNorm();
  product_ = normal_.cwiseProduct(tangential_).colwise().sum();
}

/// Least squares over both loads; where they break the law of friction, over one that just slides.
TouchSearch::Start TouchSearch::bestLoads(Index place, double alongNormal, double alongTangential) const {
  const double nn = normalSquare_[place], tt = tangentialSquare_[place], nt = product_[place];
  const auto angles = static_cast<Index>(angles_rad_.size());
  Start start;
  start.touch.angle_rad = angles_rad_[static_cast<std::size_t>(place % angles)];
  start.touch.moment_rad2 = moments_rad2_[static_cast<std::size_t>(place / angles)];
  const auto consider = [&](double normal, double tangential) {
    const double explained =
        2 * (normal * alongNormal + tangential * alongTangential) -
        (normal * normal * nn + 2 * normal * tangential * nt + tangential * tangential * tt);
    if (normal <= 0 || explained <= start.explained) return;
    start.explained = explained;
    start.touch.normal_n_per_m = normal;
    start.touch.tangential_n_per_m = tangential;
  };
  const double determinant = nn * tt - nt * nt;
  const double normal = (alongNormal * tt - alongTangential * nt) / determinant;
  const double tangential = (alongTangential * nn - alongNormal * nt) / determinant;
  if (std::abs(tangential) <= friction_ * normal) consider(normal, tangential);
  for (const double ratio : {-friction_, friction_}) {
    const double sliding =
        (alongNormal + ratio * alongTangential) / (nn + 2 * ratio * nt + ratio * ratio * tt);
    consider(sliding, ratio * sliding);
  }
  return start;
}

/// The places that are better than their neighbours in angle, best first: for every moment, since a valley
/// may bend away from the best place of the grid.
std::vector<TouchSearch::Start> TouchSearch::starts(const VectorXd& strains) const {
  const VectorXd alongNormal = normal_.transpose() * strains,
                 alongTangential = tangential_.transpose() * strains;
  const auto angles = static_cast<Index>(angles_rad_.size()), places = alongNormal.size();
  std::vector<Start> all;
  VectorXd explained(places);
  for (Index place = 0; place < places; ++place) {
    all.push_back(bestLoads(place, alongNormal[place], alongTangential[place]));
    explained[place] = all.back().explained;
  }
  std::vector<Start> peaks;
  for (Index place = 0; place < places; ++place) {
    const Index first = place / angles * angles, angle = place % angles;
    const double left = explained[first + (angle + angles - 1) % angles];
    const double right = explained[first + (angle + 1) % angles];
    if (explained[place] > std::max(left, 0.0) && explained[place] >= right)
      peaks.push_back(all[static_cast<std::size_t>(place)]);
  }
  std::ranges::sort(peaks, std::greater<>(), &Start::explained);
  const auto isFar = [&](const Start& start) { return start.explained < kNear * peaks[0].explained; };
  peaks.erase(std::ranges::find_if(peaks, isFar), peaks.end());
  if (peaks.size() > kStarts) peaks.resize(kStarts);
  return peaks;
}

std::optional<SearchResult> TouchSearch::search(const VectorXd& strains, double noise) const {
  std::vector<Candidate> candidates;
  for (const Start& start : starts(strains)) {
    const TouchFit fit = refine(model_, Profile::kEllipse, strains, noise, start.touch);
    const bool isKnown = std::ranges::any_of(
        candidates, [&](const Candidate& other) { return !areApart(other.fit, fit.touch, kSame); });
    if (fit.touch.normal_n_per_m > 0 && !isKnown) candidates.push_back({fit, penalised(fit, friction_)});
  }
  std::ranges::sort(candidates, std::less<>(), &Candidate::penalised);
  const double untouched = strains.squaredNorm() / (noise * noise);
  if (candidates.empty() || !(untouched - candidates[0].fit.chiSquared > kTouched)) return std::nullopt;
  SearchResult result{candidates[0].fit, std::nullopt};
  const PlausibleTouches places = placesOf(model_, strains, noise, candidates);
  if (places.touches.size() >= kEnough)
    result.best.covariance = covarianceAround(result.best.touch, places.touches);
  const std::vector<Touch> rivals = rivalsOf(candidates, places, result.best);
  if (rivals.empty()) return result;
  result.rivalAngle_rad = rivals[0].angle_rad;
  result.best.covariance = holding(rivals, result.best);
  return result;
}

}  // namespace strainfinger::shape
