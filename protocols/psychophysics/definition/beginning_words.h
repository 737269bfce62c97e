#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocols/definition/device_arm.h"

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

}  // namespace haptrial::protocols
