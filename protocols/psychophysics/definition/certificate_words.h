#pragma once

#include <array>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct TrialsDefinition;

/// The stage whose fields add up to the greatest stiffness.
struct StiffestStage {
  std::string name;       // empty: no stage has any
  double stiffness{0.0};  // [N/m], of a rotation [N·m/rad]
};

/// The demands of a definition's fields on one part of a handle.
struct FeltPart {
  bool felt{false};  // a field acts on it
  StiffestStage stiffest;
};
using FeltParts = std::array<FeltPart, 3>;  // by device::Part

/// Sentences on what a definition asks for and its device cannot present, as its certificate says:
/// levels that dead zone or friction hides, steps smaller than the ripple of the force, walls that
/// do not stay passive. Levels in N·m are a rotation's, those in N of the tip or the grip,
/// whichever is felt. None without a certificate.
std::vector<std::string> certificate_warnings(const TrialsDefinition& definition,
                                              const FeltParts& parts);

}  // namespace haptrial::protocols
