#pragma once
// The laws of friction that a contact can have.

namespace strainfinger::contact {

/// What happens between indenter and surface besides the normal contact.
enum class Regime {
  kFrictionless,
  kSliding,  ///< shear = friction * pressure everywhere, towards +theta for a positive friction
  kStick,    ///< the surface follows the indenter sidewards too: u_t = const
};

}  // namespace strainfinger::contact
