#pragma once
// Pictures and claims, a pair a figure; figures() lists them.

#include <vector>

#include "host/paper/figure.hpp"

namespace strainfinger::paper {

plot::Picture knifeEdgePicture(const Subject& subject);  // fig. 2
std::vector<Claim> knifeEdgeClaims();
plot::Picture frequencyPicture(const Subject& subject);  // fig. 3
std::vector<Claim> frequencyClaims();
plot::Picture impulsePicture(const Subject& subject);  // fig. 4
std::vector<Claim> impulseClaims();
plot::Picture cutOffPicture(const Subject& subject);  // fig. 5
std::vector<Claim> cutOffClaims();

}  // namespace strainfinger::paper
