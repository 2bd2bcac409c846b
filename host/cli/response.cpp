#include <vector>

#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/model_options.hpp"
#include "host/model/harmonic.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kResponseHelp =
    "How each harmonic n of the tractions on the surface acts at a radius: strains per Pa (tensor "
    "components), tau_rt in Pa per Pa, displacements in m per Pa.\n"
    "Columns _p: per unit p_n^s of p = tau_rr at r_b; _q: per unit q_n^c of q = tau_rt at r_b; tension and "
    "+theta positive. err, ett and ur are factors of sin n theta, trt and ut of cos n theta; for p_n^c the "
    "former turn to cosines, the latter to minus sines, and for q_n^s the reverse. Row 0 is of a constant "
    "p_0 and q_0.\n"
    "Numbers below 1e-307 lose digits and end as 0.";

constexpr int kMostResponseHarmonics = 1'000'000;

struct ResponseOptions {
  explicit ResponseOptions(CLI::App& command) : common(command) {
    command.add_option("--radius-m", radius_m, "Radius to look at [m]")->required()->type_name("R");
    command.add_option("--harmonics", harmonics, "Last n to print")
        ->required()
        ->type_name("N")
        ->check(isWhole(0, kMostResponseHarmonics));
  }
  CommonOptions common;
  double radius_m = 0;
  int harmonics = 0;
};

void runResponse(const ResponseOptions& options) {
  using namespace model;
  const config::Finger finger = options.common.config().finger;
  requireInRubber(options.radius_m, finger);
  const HarmonicModel<double> model(finger.annulus(), options.radius_m);
  TableWriter table(
      stdout, options.common.format(),
      {"n", "err_p", "err_q", "ett_p", "ett_q", "trt_p", "trt_q", "ur_p", "ur_q", "ut_p", "ut_q"});
  for (int n = 0; n <= options.harmonics; ++n) {
    const HarmonicResponse<double> response = model(n);
    std::vector<Cell> cells{std::int64_t{n}};
    for (const Row row : {kErr, kEtt, kTrt, kUr, kUt})
      for (const Traction traction : {kNormal, kTangential}) cells.emplace_back(response(row, traction));
    table.row(cells);
  }
}

}  // namespace

void addResponse(CLI::App& app) { addCommand<ResponseOptions>(app, "response", kResponseHelp, runResponse); }

}  // namespace strainfinger::cli
