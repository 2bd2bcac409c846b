#include <array>

#include "host/paper/figure.hpp"
#include "host/paper/figure_makers.hpp"

namespace strainfinger::paper {

namespace {

std::vector<Claim> noClaims() { return {}; }
std::string lacksNothing(const Subject&) { return {}; }

}  // namespace

const char* nameOf(Verdict verdict) {
  constexpr std::array kNames{"borne out", "in part", "not borne out"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::span<const Figure> figures() {
  static constexpr std::array kFigures{
      Figure{2, "Displacements under a knife edge at 45 degrees", knifeEdgePicture, knifeEdgeClaims,
             lacksNothing},
      Figure{3, "Frequency responses of the strains", frequencyPicture, frequencyClaims, frequencyLacks},
      Figure{4, "Impulse responses of the normal strain", impulsePicture, impulseClaims, impulseLacks},
      Figure{5, "Cut-off frequencies against alpha", cutOffPicture, cutOffClaims, cutOffLacks},
      Figure{6, "Displacements under a flat frictionless indenter", flatDisplacementPicture, noClaims,
             lacksNothing},
      Figure{7, "Surface stress under a flat frictionless indenter", flatStressPicture, flatStressClaims,
             lacksNothing},
      Figure{8, "Singular values", singularValuePicture, singularValueClaims, lacksNothing},
      Figure{9, "Singular values that matter against the contact's width", countPicture, countClaims,
             lacksNothing},
      Figure{10, "Basis functions", basisPicture, basisClaims, lacksNothing},
  };
  return kFigures;
}

}  // namespace strainfinger::paper
