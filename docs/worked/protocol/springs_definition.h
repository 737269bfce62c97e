#pragma once

#include <string>
#include <vector>

#include "depth_log.h"
#include "protocols/definition/definition.h"

/// Definition of two springs.
struct SpringsDefinition final : haptrial::protocols::Definition {
  double standard{0.0};    // stiffness of the one spring [N/m]
  double difference{0.0};  // of the other, at first [N/m]
  double factor{0.0};      // of a step of the staircase
  double interval{0.0};    // [s]

  bool has_target() const override { return false; }
  std::vector<std::string> description() const override {
    return {"two springs, one after the other; a button says which was stiffer"};
  }
  std::vector<haptrial::stream::SideStream> side_streams() const override {
    return {depth_stream(rate)};
  }
  double longest(int trials) const override { return trials * (2.0 * interval + 2.0); }
};
