// touch_world CONFIG SCENARIO SECONDS TABLES RECORDS EXPECTED: a finger that a scenario touches.
// Writes to RECORDS what an emulated board must be told of it (firmware/board/mps2/world_record.hpp), and to
// EXPECTED what it must then say: a line for each frame of a touch, the frame as candump -L has it and what
// really touched the finger then: 181#.., time_s, angle_deg, normal_n, tangential_n.
#include <fmt/os.h>

#include <cstdlib>
#include <numbers>
#include <vector>

#include "firmware/app/finger.hpp"
#include "firmware/board/mps2/settings.hpp"
#include "firmware/board/mps2/world.hpp"
#include "host/can/candump_text.hpp"
#include "host/config/read_config.hpp"
#include "host/simulation/read_scenario.hpp"
#include "host/simulation/simulated_gauges.hpp"
#include "host/tables/table_file.hpp"
#include "tests/firmware/board/fake_world_line.hpp"

using namespace strainfinger;

namespace {

struct Port {
  std::vector<CanFrame> sent;
  bool idle() const { return true; }
  bool send(const CanFrame& frame) noexcept {
    sent.push_back(frame);
    return true;
  }
  std::optional<CanFrame> receive() noexcept { return std::nullopt; }
  hal::CanStatus status() const noexcept {
    return {.state = hal::CanState::kActive, .txErrors = 0, .rxErrors = 0};
  }
};

struct Watchdog {
  void feed() noexcept {}
  hal::ResetCause resetCause() const noexcept { return hal::ResetCause::kPowerOn; }
};

std::string textOf(const CanFrame& frame) {
  const std::string line = can::formatLogLine(0, "x", frame);
  return line.substr(line.rfind(' ') + 1);
}

std::string truthOf(const std::vector<simulation::Touch>& touches, double length_m) {
  if (touches.size() != 1) return ",,";
  const simulation::Touch& touch = touches.front();
  return fmt::format("{},{},{}", touch.angle_rad * 180 / std::numbers::pi, touch.normal_n_per_m * length_m,
                     touch.tangential_n_per_m * length_m);
}

bool isTouch(const CanFrame& frame) {
  return decode<ContactFrame>(frame) || decode<ForceFrame>(frame) || decode<PatchFrame>(frame) ||
         decode<Contact2Frame>(frame) || decode<Force2Frame>(frame);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 7) return 2;
  const auto config = config::readConfigFile(arguments[1]);
  const auto node = static_cast<std::uint8_t>(config.can.node);
  const auto tables = tables::readTableFile(arguments[4]);
  simulation::SimulatedClock time;
  simulation::SimulatedGauges gauges(config, simulation::readScenarioFile(arguments[2]), time,
                                     {.seed = node});
  mps2::FakeWorldLine line;
  Port port;
  Watchdog watchdog;
  mps2::World world(line, port);
  firmware::Finger finger(*tables, mps2::settingsOf(node), world, port, world, watchdog);
  auto records = fmt::output_file(arguments[5]);
  auto expected = fmt::output_file(arguments[6]);
  for (double end_s = std::atof(arguments[3]); static_cast<double>(time.elapsed_us()) * 1e-6 < end_s;) {
    time.advance_us(mps2::kRecordPeriod_us);
    hal::SampleSet set{};
    if (!gauges.read(set)) return 1;
    const auto codes = std::span(set).first(static_cast<std::size_t>(config.gauges.count));
    const auto told = mps2::bytesOf(mps2::samplesRecord(codes));
    for (const std::uint8_t byte : told) records.print("{}", static_cast<char>(byte));
    line.tell(told);
    port.sent.clear();
    world.poll([](const mps2::WorldRecord&) {});
    while (finger.step()) continue;
    for (const CanFrame& frame : port.sent)
      if (isTouch(frame))
        expected.print("{},{},{}\n", textOf(frame), gauges.sampleTime_s(),
                       truthOf(gauges.truth(), config.finger.length_m));
  }
}
