#pragma once
// What a user tells a session.

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace strainfinger::session {

struct LoadIs {
  double normal_n_per_m;
};
struct AngleIs {
  double angle_deg;
};
/// What is held now is what the next load or angle is of.
struct Hold {};
struct Tare {};
/// Whether a zero may be taken, before the user is asked to confirm it: the key t, but no line.
struct MayTare {};
struct Skip {};
/// The last load or angle was a mistake.
struct Undo {};
struct Quit {};
/// Not understood, and why.
struct Unclear {
  std::string why;
};
using Command = std::variant<LoadIs, AngleIs, Hold, Tare, MayTare, Skip, Undo, Quit, Unclear>;

/// "load 200 g", "load 2 N", "load 24.5 N/m", "angle 40", "hold", "tare", "skip", "undo", "quit"; blanks
/// don't matter. `length_m`: of the finger, turns N into N/m.
Command parseCommand(std::string_view line, double length_m);

/// What is typed on a terminal, key by key: `l` and `a` hold what is pressed and ask for its load or angle,
/// which Return enters and Escape drops; t asks whether to tare, which y does.
class KeyReader {
 public:
  /// `length_m`: as parseCommand()'s.
  explicit KeyReader(double length_m) : length_m_(length_m) {}

  /// A whole command, when this key makes it one. It wants an answer().
  std::optional<Command> press(unsigned char key);

  /// Whether that was obeyed. Where it wasn't, what a key began to ask for is not asked, and a load or an
  /// angle that was entered can be corrected.
  void answer(bool isObeyed);

  /// What is asked and was typed so far; empty: nothing.
  std::string prompt() const;

 private:
  enum class Mode { kKeys, kLoad, kAngle, kTare };
  double length_m_;
  Mode mode_ = Mode::kKeys;
  bool isEntered_ = false;
  std::string typed_;
};

}  // namespace strainfinger::session
