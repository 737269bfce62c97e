#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocols/definition/definition.h"

namespace haptrial::scene {
class Scene;
}

namespace haptrial::protocols {

struct Presented;
struct TrialsDefinition;

/// Names the fields that may begin where a hand is, over sets of values: of each stage and field it
/// keeps the hardest push. Forces are those of the scene itself on a hand at rest.
class BeginningReport {
 public:
  explicit BeginningReport(const TrialsDefinition& definition);
  /// Bodies that give way are felt only if they are prepared.
  void add(const Presented& presented);
  /// A sentence for each of them, in the order of stages and fields.
  std::vector<std::string> lines() const;

 private:
  struct Push {
    std::string stage;
    std::string field;   // with its table
    double force{0.0};   // [N]
    double within{0.0};  // [s]
    std::size_t device{0};
  };
  using Key = std::pair<std::size_t, std::size_t>;  // numbers of stage and field

  std::vector<std::size_t> unknown(const Presented& presented, std::size_t stage,
                                   std::size_t device, std::uint64_t begins) const;
  void look(const Presented& presented, std::size_t stage, std::size_t device,
            std::vector<std::size_t> fields, scene::Scene& scene);
  double most(const Presented& presented, std::size_t field, std::size_t device) const;

  double rate_;
  std::vector<DeviceArm> arms_;
  std::map<Key, Push> pushes_;
};

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
