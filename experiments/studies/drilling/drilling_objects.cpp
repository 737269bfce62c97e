#include "experiments/studies/drilling/drilling_objects.h"

#include "core/base/kept.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/surface/surface_mesh.h"

namespace haptrial::experiments {
namespace {

constexpr std::size_t kBoneTriangles = 2500;  // of the whole bone, thinned
constexpr std::size_t kPartTriangles = 200;   // of a structure

/// A bone in the space of the hand.
struct FeltBone {
  std::shared_ptr<const bone::BoneModel> model;
  protocols::BonePlacement placement;
  double scale{1.0};
  bool operator==(const FeltBone&) const = default;
};

SpaceObject object_of(const FeltBone& felt, const std::string& name, const geometry::Mesh& mesh,
                      std::size_t triangles) {
  const Eigen::Isometry3d pose = pose_of(felt.placement, felt.model->grid);
  SpaceObject object{name, 0, lines_of(mesh, triangles)};
  for (auto& [from, to] : object.lines) {
    from = felt.scale * (pose * from);
    to = felt.scale * (pose * to);
  }
  return object;
}

std::vector<SpaceObject> made(const FeltBone& felt) {
  const bone::BoneModel& model = *felt.model;
  std::vector<SpaceObject> all{
      object_of(felt, "bone", bone::surface_mesh(bone::BoneVolume(model)), kBoneTriangles)};
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    const std::string& name = model.structures[label].name;
    if (name != bone::kPlainBone) {
      all.push_back(object_of(felt, name,
                              bone::structure_mesh(model, static_cast<std::uint8_t>(label)),
                              kPartTriangles));
    }
  }
  std::erase_if(all, [](const SpaceObject& object) { return object.lines.empty(); });
  return all;
}

}  // namespace

std::shared_ptr<const std::vector<SpaceObject>> objects_of(const protocols::PlacedBone& bone,
                                                           double scale) {
  static Kept<FeltBone, std::vector<SpaceObject>> kept(2);
  const FeltBone felt{bone.model, bone.placement, scale};
  return kept.get(felt,
                  [&] { return std::make_shared<const std::vector<SpaceObject>>(made(felt)); });
}

}  // namespace haptrial::experiments
