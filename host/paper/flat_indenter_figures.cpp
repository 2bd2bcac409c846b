// Figs. 6 and 7: displacements and surface stress under a flat frictionless indenter.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/contact/contact_field.hpp"
#include "host/contact/paper_method.hpp"
#include "host/paper/displaced_points.hpp"
#include "host/paper/figure_makers.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

using std::numbers::pi;

constexpr std::array kPaperCutOffs{0.1, 0.01, 1e-3};

constexpr const char* kIndenter = R"(
set arrow 1 from indenterX,-indenterY to indenterX,indenterY nohead linewidth 2 linecolor rgb vermilion; applied = 'indenter'
)";

constexpr const char* kStressPanel = R"(
set xlabel 'θ (rad)'; set ylabel 'pressure (kPa)'
set xrange [-3*half:3*half]; set key inside top right vertical Right
set arrow 1 from -half,graph 0 to -half,graph 1 nohead dashtype 3 linecolor rgb faint
set arrow 2 from half,graph 0 to half,graph 1 nohead dashtype 3 linecolor rgb faint
plot data('pressure') using 1:($2/1e3) every ::1 with lines linewidth 2 linecolor rgb blue title 'spectral', \
     '' using 1:($3/1e3) every ::1 with lines dashtype 2 linewidth 1.6 linecolor rgb black title 'Hertz, same width', \
     '' using 1:($4/1e3) every ::1 with lines linewidth 1.4 linecolor rgb vermilion title 'paper''s method, cut-off 1/10', \
     '' using 1:($5/1e3) every ::1 with lines linewidth 1.4 linecolor rgb orange title '1/100', \
     '' using 1:($6/1e3) every ::1 with lines linewidth 1.4 linecolor rgb green title '1/1000'
)";

/// The finger and the contact, both solved.
struct FlatContact {
  contact::SurfaceKernel kernel;
  contact::Contact solution;
  double half_m;

  explicit FlatContact(const Subject& subject)
      : kernel(subject.annulus), half_m(subject.contactWidth_m() / 2) {
    contact::ContactRequest request;
    request.size.value = 2 * half_m;
    solution = contact::solveContact(kernel, request);
  }

  double half_rad() const { return half_m / kernel.annulus().outer_radius_m; }
  double pressure_pa(double angle_rad) const {
    return contact::tractionAt(solution.tractions, angle_rad).pressure_pa;
  }
};

/// A semi-ellipse over the contact.
struct Ellipse {
  double peak_pa, half_m;

  double pressure_pa(double x_m) const {
    const double x = x_m / half_m;
    return std::abs(x) < 1 ? peak_pa * std::sqrt(1 - x * x) : 0;
  }
  double load_n_per_m() const { return pi / 2 * peak_pa * half_m; }
};

/// A plane on a cylinder that is a half plane inside (Johnson 1985, sec. 4.2c): p0 = E* a / 2 r_b.
Ellipse hertz(const FlatContact& flat) {
  const model::Annulus<double>& annulus = flat.kernel.annulus();
  const double modulus_pa = 2 * annulus.shear_modulus_pa / (1 - annulus.poisson_ratio);
  return {modulus_pa * flat.half_m / (2 * annulus.outer_radius_m), flat.half_m};
}

contact::PaperContact byPaper(const FlatContact& flat, double cutOff) {
  contact::PaperOptions options;
  options.cutoff = cutOff;
  options.rows = contact::SlopeRows::kGauss;
  return contact::solveByPaper(flat.kernel.annulus(), contact::Indenter::flat(), 2 * flat.half_m, options);
}

/// Largest |departure(x)| over the contact, x in m.
template <typename Departure>
double worstInside(double half_m, const Departure& departure) {
  constexpr int kPlaces = 1000;
  double worst = 0;
  for (int i = -kPlaces; i <= kPlaces; ++i)
    worst = std::max(worst, std::abs(departure(half_m * i / (kPlaces + 1.0))));
  return worst;
}

}  // namespace

plot::Picture flatDisplacementPicture(const Subject& subject) {
  const FlatContact flat(subject);
  const double radius_m = subject.annulus.outer_radius_m;
  plot::DataFile data =
      displacedPoints(subject.annulus, [&](double at_m, std::span<const double> angles_rad) {
        return contact::computeContactField(flat.kernel, flat.solution.tractions, at_m, angles_rad,
                                            kDisplacements);
      });
  const std::string numbers =
      fmt::format("indenterX = {}; indenterY = {}\n", radius_m - flat.solution.approach_m, 2 * flat.half_m);
  return {
      900, 900, plot::kStyle + numbers + kIndenter + drawDisplacedPoints(subject.annulus), {std::move(data)}};
}

plot::Picture flatStressPicture(const Subject& subject) {
  constexpr int kAnglesOfAHalf = 300;
  const FlatContact flat(subject);
  const Ellipse ideal = hertz(flat);
  plot::DataFile data{"pressure", {"angle_rad", "pressure_pa", "hertz_pa"}, {}};
  std::vector<contact::PaperContact> papers;
  for (const double cutOff : kPaperCutOffs) {
    papers.push_back(byPaper(flat, cutOff));
    data.columns.push_back(fmt::format("paper_cut_off_{}_pa", cutOff));
  }
  for (int i = -kAnglesOfAHalf; i <= kAnglesOfAHalf; ++i) {
    const double angle_rad = 3 * flat.half_rad() * i / kAnglesOfAHalf;
    data.rows.push_back({angle_rad, flat.pressure_pa(angle_rad),
                         ideal.pressure_pa(angle_rad * subject.annulus.outer_radius_m)});
    for (const contact::PaperContact& paper : papers)
      data.rows.back().push_back(contact::tractionAt(paper.tractions, angle_rad).pressure_pa);
  }
  const std::string numbers = fmt::format("half = {}\n", flat.half_rad());
  return {900, 560, plot::kStyle + numbers + kStressPanel, {std::move(data)}};
}

std::vector<Claim> flatStressClaims() {
  constexpr double kAlike = 0.01;
  const FlatContact flat(paperSubject());
  const double radius_m = flat.kernel.annulus().outer_radius_m, peak_pa = flat.pressure_pa(0);
  const Ellipse own{peak_pa, flat.half_m}, ideal = hertz(flat);
  const double shape = worstInside(flat.half_m, [&](double x_m) {
    return flat.pressure_pa(x_m / radius_m) / peak_pa - own.pressure_pa(x_m) / peak_pa;
  });
  const contact::PaperContact paper = byPaper(flat, kPaperCutOffs[0]);
  const double method = worstInside(flat.half_m, [&](double x_m) {
    return (contact::tractionAt(paper.tractions, x_m / radius_m).pressure_pa -
            flat.pressure_pa(x_m / radius_m)) /
           peak_pa;
  });
  const double load = flat.solution.normal_n_per_m, excess = load / ideal.load_n_per_m() - 1;
  const bool isShape = shape < kAlike, isSize = std::abs(excess) < kAlike;
  return {{"hertz",
           "a flat frictionless indenter, 2 mm wide, makes the parabolic stress of a Hertz contact (sec. 4, "
           "fig. 7)",
           fmt::format(
               "load {:.4f} N/m and peak {:.2f} Pa, {:.2f} % and {:.2f} % above Hertz; within {:.1e} of the "
               "peak of a semi-ellipse; the paper's method at a cut-off of 1/10 is wrong by {:.2f} of the "
               "peak, its load by {:.0f} %",
               load, peak_pa, 100 * excess, 100 * (peak_pa / ideal.peak_pa - 1), shape, method,
               100 * (paper.normal_n_per_m / load - 1)),
           isShape && isSize   ? Verdict::kBorneOut
           : isShape || isSize ? Verdict::kInPart
                               : Verdict::kNotBorneOut}};
}

}  // namespace strainfinger::paper
