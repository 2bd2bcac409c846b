#include "host/contact/contact.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/contact_options.hpp"
#include "host/contact/fourier_tractions.hpp"
#include "host/contact/paper_method.hpp"
#include "host/contact/surface_motion.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kContactHelp =
    "What an indenter and the finger exert on each other: pressure (positive when pressing), shear (positive "
    "towards +theta) and the slope d u_r / d theta [m/rad] of the surface, against the angle from the "
    "indenter's normal.\n"
    "Where they touch, u_r = -approach + x^2 / 2 r_b + height(x), x = r_b theta: the paper's convention, in "
    "which a flat indenter's slope is r_b theta. How far the answer, recomputed from its tractions, is from "
    "that is the residual, told on stderr, as is where it touches in several regions. Exactly below the edge "
    "of a wedge the pressure is infinite.\n"
    "Loads are sums of pressure and shear along the surface. What a load cell at the core reads, along the "
    "indenter's normal and sidewards, is told on stderr: it is another force, as the surface turns away from "
    "the normal in a wide contact.\n"
    "A cylinder is the parabola x^2 / 2 R, a wedge two planes. Strains are taken to be small; a warning "
    "tells where they aren't.\n"
    "The summary's offset is the contact's centre, its depth that of the indenter's profile below the "
    "undeformed surface at the contact's centre: below 0 if that is between regions, where the profile "
    "stands clear.\n"
    "Prints angle_deg,pressure_pa,shear_pa,slope; with --summary "
    "normal_n_per_m,tangential_n_per_m,width_m,depth_m,offset_deg,residual_m.";

/// Time grows with the cube: 1000 by the printed rows take 1.4 s, 2000 by Gauss's 0.4 s.
constexpr int kMostHarmonics = 2000, kMostPrintedHarmonics = 1000;

struct ContactCommand {
  explicit ContactCommand(CLI::App& command) : common(command), contact(command) {
    CLI::Option* const alone =
        command.add_flag("--summary", summary, "Loads, width, depth, offset and residual only, as one row");
    auto& list = *addList(command, "--at-deg", at_deg,
                          "Angles to look at, from the indenter's normal [degrees], separated by commas",
                          isFrom(-180, 180))
                      .type_name("a,b")
                      ->excludes(alone);
    command
        .add_option(
            "--points", points,
            fmt::format("Or: so many, in the middle of as many equal parts of twice the contact's width ({})",
                        points))
        ->type_name("N")
        ->check(isWhole(1, 1'000'000))
        ->excludes(&list)
        ->excludes(alone);
    command
        .add_option("--method", method,
                    "spectral (default), or paper: windowed Fourier series of the pressure, pseudo-inverse")
        ->check(CLI::IsMember({"spectral", "paper"}));
    ofPaper = {
        command
            .add_option(
                "--harmonics", paper.harmonics,
                fmt::format("Of --method paper: last harmonic n_c ({}); at most {} with --rows printed",
                            paper.harmonics, kMostPrintedHarmonics))
            ->check(isWhole(2, kMostHarmonics)),
        command
            .add_option("--cutoff", paper.cutoff,
                        "Of --method paper: singular values from there on, relative")
            ->capture_default_str()
            ->check(isFrom(0, 1)),
        command
            .add_option(
                "--rows", rows,
                "Of --method paper: printed (default), the paper's even points, or gauss: the continuum")
            ->check(CLI::IsMember({"printed", "gauss"})),
        command
            .add_option("--window", window,
                        "Of --method paper: last coefficient of the window: half (default) of n_c, as "
                        "printed, or full")
            ->check(CLI::IsMember({"half", "full"}))};
  }
  contact::PaperOptions paperOptions() const {
    contact::PaperOptions options = paper;
    options.rows = rows == "gauss" ? contact::SlopeRows::kGauss : contact::SlopeRows::kPrinted;
    if (rows == "printed" && paper.harmonics > kMostPrintedHarmonics)
      throw Failure(
          ExitCode::kUsage,
          fmt::format("--harmonics: at most {} with the paper's even points; add --rows gauss, which "
                      "has the continuum's values at a fraction of the cost",
                      kMostPrintedHarmonics));
    options.window = window == "full" ? contact::WindowCut::kFull : contact::WindowCut::kHalf;
    return options;
  }
  CommonOptions common;
  ContactOptions contact;
  bool summary = false;
  std::vector<double> at_deg;
  int points = 400;
  std::string method = "spectral";
  contact::PaperOptions paper;
  std::string rows = "printed";
  std::string window = "half";
  std::vector<CLI::Option*> ofPaper;
};

/// In the middle of `points` equal parts of twice the contact.
std::vector<double> anglesOf(const ContactCommand& options, double offset_rad, double width_rad) {
  std::vector<double> angles_rad;
  for (const double angle_deg : options.at_deg) angles_rad.push_back(angle_deg * kRadPerDeg);
  for (int i = 0; i < options.points && options.at_deg.empty(); ++i)
    angles_rad.push_back(offset_rad + width_rad * (2 * (i + 0.5) / options.points - 1));
  return angles_rad;
}

void printSummary(const ContactCommand& options, const contact::Contact& contact) {
  TableWriter table(
      stdout, options.common.format(),
      {"normal_n_per_m", "tangential_n_per_m", "width_m", "depth_m", "offset_deg", "residual_m"});
  table.row({contact.normal_n_per_m, contact.tangential_n_per_m, contact.width_m, contact.depth_m,
             contact.offset_rad / kRadPerDeg, contact.residual_m});
}

void printTractions(const ContactCommand& options, const contact::SurfaceKernel& kernel,
                    const contact::Contact& contact) {
  const contact::SurfaceMotion motion(kernel, contact.tractions);
  TableWriter table(stdout, options.common.format(), {"angle_deg", "pressure_pa", "shear_pa", "slope"});
  const double width_rad = contact.width_m / kernel.annulus().outer_radius_m;
  for (const double angle_rad : anglesOf(options, contact.offset_rad, width_rad)) {
    const contact::Traction traction = contact::tractionAt(contact.tractions, angle_rad);
    table.row(
        {angle_rad / kRadPerDeg, traction.pressure_pa, traction.shear_pa, motion.at(angle_rad).urSlope_m});
  }
}

void printPaper(const ContactCommand& options, const model::Annulus<double>& annulus, double width_m,
                const contact::PaperContact& found) {
  if (options.summary) {
    contact::Contact summary;
    summary.normal_n_per_m = found.normal_n_per_m;
    summary.width_m = width_m;
    summary.depth_m = found.depth_m;
    summary.residual_m = found.residual_m;
    return printSummary(options, summary);
  }
  TableWriter table(stdout, options.common.format(), {"angle_deg", "pressure_pa", "shear_pa", "slope"});
  for (const double angle_rad : anglesOf(options, 0, width_m / annulus.outer_radius_m)) {
    const contact::Traction traction = contact::tractionAt(found.tractions, angle_rad);
    table.row({angle_rad / kRadPerDeg, traction.pressure_pa, traction.shear_pa,
               contact::surfaceAt(annulus, found.tractions, angle_rad).urSlope_m});
  }
}

/// Against the spectral answer, centred as the paper's is.
void tellErrors(const model::Annulus<double>& annulus, contact::ContactRequest request,
                const contact::PaperContact& found) {
  request.centre_rad = 0;
  const contact::Contact exact = contact::solveContact(contact::SurfaceKernel(annulus), request);
  const contact::PaperErrors errors = contact::errorsOf(found, exact);
  const bool hasPeak = std::isfinite(errors.centre);
  tell(
      "contact: against --method spectral, per its {}: pressure off by {:.2g} at worst{}, load by {:+.3g} %; "
      "outside the contact {:.2g} at worst, {:.1g} of the pressure's square\n",
      hasPeak ? "peak" : "mean pressure", errors.inside,
      hasPeak ? fmt::format(", by {:.2g} at the centre", errors.centre)
              : " but for the edge, where it is infinite",
      100 * errors.load, errors.outside, errors.leakedShare);
  if (exact.residual_m > 1e-6 * std::abs(exact.depth_m))
    warn("contact",
         "no contact of this indenter is centred on its normal, where --method paper holds it; --method "
         "spectral moves it to where it fits");
  if (!(found.depth_m > 0 && found.normal_n_per_m > 0))
    warn("contact",
         fmt::format("depth {:.2g} m, load {:.2g} N/m: what pulls the surface out is no contact; raise "
                     "--cutoff, or take --method spectral",
                     found.depth_m, found.normal_n_per_m));
}

void runPaper(const ContactCommand& options, const model::Annulus<double>& annulus,
              const contact::ContactRequest& request) {
  if (request.regime != contact::Regime::kFrictionless || request.centre_rad ||
      request.size.kind != contact::ContactSize::Kind::kWidth)
    throw Failure(
        ExitCode::kUsage,
        "--method paper knows frictionless contacts of given width, centred on the indenter's normal");
  const auto found =
      contact::solveByPaper(annulus, request.indenter, request.size.value, options.paperOptions());
  tell("contact: residual {:.2g} m; {} singular values kept, {} of them with an even pressure\n",
       found.residual_m, found.kept, found.keptEven);
  if (found.keptEven == 0)
    throw Failure(
        ExitCode::kFailure,
        "contact: no singular value of an even pressure is kept, so there is no answer: raise --harmonics, "
        "or lower --cutoff");
  warn("contact", "--method paper is inaccurate by its nature; --method spectral is not");
  tellErrors(annulus, request, found);
  printPaper(options, annulus, request.size.value, found);
}

/// Of pressure and shear, which turn with the surface: sums of their first harmonics.
void tellForces(const contact::Contact& contact, double radius_m) {
  const Eigen::RowVector4d first =
      std::numbers::pi * radius_m * contact::fourierTractions(contact.tractions, 1).row(1);
  const double along = first[0] + first[3], sidewards = first[2] - first[1];
  constexpr double kRounding = 1e-12;
  tell("contact: force {:.6g} N/m along the indenter's normal, {:.6g} N/m sidewards\n", along,
       std::abs(sidewards) < kRounding * std::abs(along) ? 0 : sidewards);
  if (along < 0)
    warn("contact",
         "the indenter would have to be pulled: friction presses the surface against it from both sides, and "
         "the normal load is that of the pressure alone");
}

void runContact(const ContactCommand& options) {
  const config::FingerConfig config = options.common.config();
  const contact::ContactRequest request = options.contact.request(config);
  for (const CLI::Option* option : options.ofPaper)
    if (options.method != "paper" && option->count() > 0)
      throw Failure(ExitCode::kUsage, option->get_name() + " goes with --method paper");
  if (options.method == "paper") return runPaper(options, config.finger.annulus(), request);
  const contact::SurfaceKernel kernel(config.finger.annulus());
  const contact::Contact contact = contact::solveContact(kernel, request);
  tellOf("contact", contact, request, config);
  tellForces(contact, kernel.annulus().outer_radius_m);
  if (options.summary)
    printSummary(options, contact);
  else
    printTractions(options, kernel, contact);
}

}  // namespace

void addContact(CLI::App& app) { addCommand<ContactCommand>(app, "contact", kContactHelp, runContact); }

}  // namespace strainfinger::cli
