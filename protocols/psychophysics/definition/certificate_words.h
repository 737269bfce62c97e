#pragma once

#include <string>
#include <vector>

namespace haptrial::protocols {

struct TrialsDefinition;

/// The stage whose fields add up to the greatest stiffness.
struct StiffestStage {
  std::string name;       // empty: no stage has any
  double stiffness{0.0};  // [N/m]
};

/// Sentences on what a definition asks for and its device cannot present, as its certificate says:
/// levels that dead zone or friction hides, steps smaller than the ripple of the force, walls that
/// do not stay passive. None without a certificate.
std::vector<std::string> certificate_warnings(const TrialsDefinition& definition,
                                              const StiffestStage& stiffest);

}  // namespace haptrial::protocols
