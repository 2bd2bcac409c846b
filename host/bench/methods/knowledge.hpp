#pragma once
// What the methods know of the finger: tables and weights, made by make_knowledge.hpp.

#include "host/bench/methods/global_search.hpp"
#include "host/bench/methods/global_width_search.hpp"
#include "host/bench/methods/perceptron.hpp"
#include "host/bench/methods/starts.hpp"
#include "host/bench/methods/templates.hpp"

namespace strainfinger::bench {

struct Knowledge {
  RingResponse<float> response;
  TemplateBank templates;
  ScanBank scan;
  GlobalBank<float> global;
  PatchTable<float> patches;
  WidthBank<float> widths;
  Perceptron perceptron;
};

}  // namespace strainfinger::bench
