#pragma once
// Pictures, claims and what pictures lack; figures() lists them.

#include <string>
#include <vector>

#include "host/paper/figure.hpp"

namespace strainfinger::paper {

plot::Picture knifeEdgePicture(const Subject& subject);  // fig. 2
std::vector<Claim> knifeEdgeClaims();
plot::Picture frequencyPicture(const Subject& subject);  // fig. 3
std::vector<Claim> frequencyClaims();
std::string frequencyLacks(const Subject& subject);
plot::Picture impulsePicture(const Subject& subject);  // fig. 4
std::vector<Claim> impulseClaims();
std::string impulseLacks(const Subject& subject);
plot::Picture cutOffPicture(const Subject& subject);  // fig. 5
std::vector<Claim> cutOffClaims();
std::string cutOffLacks(const Subject& subject);
plot::Picture flatDisplacementPicture(const Subject& subject);  // fig. 6, of which the paper claims nothing
plot::Picture flatStressPicture(const Subject& subject);        // fig. 7
std::vector<Claim> flatStressClaims();
plot::Picture singularValuePicture(const Subject& subject);  // fig. 8
std::vector<Claim> singularValueClaims();
plot::Picture countPicture(const Subject& subject);  // fig. 9
std::vector<Claim> countClaims();
plot::Picture basisPicture(const Subject& subject);  // fig. 10
std::vector<Claim> basisClaims();

std::vector<Claim> locatingClaims();        // of sec. 6, by fig. 4
std::vector<Claim> discriminationClaims();  // of sec. 6, by figs. 5 and 10
std::vector<Claim> shearClaims();           // of sec. 6, by fig. 5

}  // namespace strainfinger::paper
