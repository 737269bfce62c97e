#include "experiments/studies/drilling/drilling_preview.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/shared_cache.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/surface/surface_mesh.h"
#include "core/render/gl/image.h"
#include "experiments/preview/fixed_plan.h"
#include "experiments/preview/preview_pictures.h"
#include "experiments/preview/trials_parts.h"
#include "protocols/bone_drilling/bone_trials.h"
#include "protocols/bone_drilling/burr_forces.h"
#include "protocols/bone_drilling/display/placement_picture.h"

namespace haptrial::experiments {
namespace {

using protocols::BoneDefinition;
using protocols::BurrForce;

void add_timeline(const BoneDefinition& d, const protocols::PlannedTrial& trial, Preview& preview) {
  const double limit = d.drilling.time_limit;
  preview.document.heading("One trial, stage by stage");
  preview.document.paragraph(fmt::format(
      "Procedure {} of {}{}. It has one stage, no questions, and the sound of the drill is {}; "
      "practice of people before the first procedure takes {:g} s.",
      trial.trial, d.design.trials, trial.condition.empty() ? "" : ", condition " + trial.condition,
      d.sound_card ? "played" : "not played", d.practice));
  const std::vector<TimelineBar> bars{
      {"drilling", fmt::format("at most {:g} s", limit), 0.0, true}};
  preview.add(timeline_figure(bars.size()), timeline_svg(bars));
  preview.document.table(
      {"stage", "lasts [s]", "ends"},
      {{"drilling", fmt::format("at most {:g}", limit),
        "when the participant says so (function finish), or when the time is over"}});
}

/// A bone's picture, one of the last few if nothing that it shows has changed.
std::shared_ptr<const render::Image> kept_picture(const protocols::PlacedBone& bone) {
  static SharedCache<protocols::PlacedBone, render::Image> kept(2);
  return kept.get(bone, [&] {
    return std::make_shared<const render::Image>(protocols::placement_picture(bone));
  });
}

void add_seen(const BoneDefinition& d, std::size_t bone, Preview& preview) {
  constexpr int kWide = 900;  // [px]
  protocols::PlacedBone placed = protocols::placed_bone(d, bone);
  const int coarser = (placed.width + kWide - 1) / kWide;
  placed.width /= coarser;
  placed.height /= coarser;
  const auto image = kept_picture(placed);
  const std::string words = fmt::format("the first picture, bone {} of {}: {}", bone + 1,
                                        d.bones.size(), d.bones[bone]->name);
  preview.document.heading("What the participant sees");
  preview.add(gallery_figure({words},
                             "By the drawing of sessions. Names, the structures that show "
                             "through, axes and scale are not there in a session."),
              gallery_svg({{render::png_bytes(*image), image->width, image->height, words}}));
}

void add_burr_figure(const std::vector<BurrForce>& burrs, double limit, Preview& preview) {
  analysis::Figure figure;
  figure.name = "burr-force";
  figure.title = "Force of the burr over depth";
  figure.x_label = "depth of the burr's lowest point [mm]";
  figure.y_label = "force on the hand [N]";
  figure.height = 0.45;
  figure.caption = fmt::format(
      "The force of flat bone on an upright burr that does not turn, by the simulator of sessions. "
      "The device "
      "is asked for at most {:g} N.",
      limit);
  std::string alt;
  for (const BurrForce& burr : burrs) {
    analysis::Series series{burr.tool, analysis::Mark::kLine, curve_look(figure.series.size())};
    for (std::size_t i = 0; i < burr.depths.size(); ++i) {
      series.x.push_back(1e3 * burr.depths[i]);
      series.y.push_back(burr.forces[i].norm());
    }
    alt += fmt::format("{}{}: {:.3g} N at {:.3g} mm", alt.empty() ? "" : "; ", burr.tool,
                       series.y.back(), series.x.back());
    figure.series.push_back(std::move(series));
  }
  figure.alt = alt + ".";
  preview.add(std::move(figure));
}

void add_burr_table(const std::vector<BurrForce>& burrs, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  for (const BurrForce& burr : burrs) {
    const bone::BurrParameters& shape = burr.burr.burr;
    const bone::FeelParameters& feel = burr.burr.feel;
    rows.push_back(
        {burr.tool, fmt::format("{:g}", 1e3 * shape.diameter),
         fmt::format("{:.3g}", 1e-9 * feel.first_gain),
         fmt::format("{:.3g}", 1e-9 * feel.second_gain),
         fmt::format("{:.3g}", 1e9 * feel.threshold), fmt::format("{:g}", feel.force_limit),
         fmt::format("{:.2f}", 1e-3 * burr.stiffness), fmt::format("{:g}", shape.removal_rate),
         fmt::format("{:.3g}", shape.tangential_gain)});
  }
  preview.document.table({"burr", "diameter [mm]", "first gain [N/mm³]", "second gain [N/mm³]",
                          "gain changes at [mm³]", "limit [N]", "stiffness of flat bone [N/mm]",
                          "removal rate [1/(N·s)]", "tangential gain [N/m⁴]"},
                         rows);
}

void add_plan(const BoneDefinition& d, std::uint64_t seed, analysis::Document& document) {
  add_fixed_plan(
      d,
      [&](int participant) {
        return protocols::procedures_of(d, previewed_session(seed, participant));
      },
      document);
}

}  // namespace

protocols::PlannedTrial procedure_of(const BoneDefinition& d, const PreviewRequest& request) {
  const auto plan = protocols::procedures_of(d, previewed_session(request.seed));
  const auto most = static_cast<int>(plan.size());
  if (request.trial < 1 || request.trial > most) {
    throw InputError(
        fmt::format("--trial is {}; allowed: 1 to {}, the procedures of a session of {}",
                    request.trial, most, d.file_name));
  }
  return plan[static_cast<std::size_t>(request.trial - 1)];
}

std::size_t bone_of(const BoneDefinition& d, const protocols::PlannedTrial& trial) {
  return static_cast<std::size_t>(trial.trial - 1) % d.bones.size();
}

void add_drilling_methods(const BoneDefinition& d, std::uint64_t seed,
                          analysis::Document& document) {
  std::vector<std::string> tools;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    tools.push_back(tool.name);
  }
  document.heading("Stimuli and procedure");
  std::string words = fmt::format(
      "Each participant drilled {} procedures of at most {:g} s, each on a new bone ({}), with {}; "
      "the force was limited to {:g} N.",
      d.design.trials, d.drilling.time_limit, fmt::join(d.sources, ", "), fmt::join(tools, ", "),
      d.drilling.force_limit);
  words += d.practice > 0.0
               ? fmt::format(
                     " People practised for {:g} s before the first one; dry runs leave it "
                     "out.",
                     d.practice)
               : "";
  words += d.design.break_after > 0
               ? fmt::format(" Breaks of {:g} s came after every {}.", d.design.break_duration,
                             counted(d.design.break_after, "procedure", "procedures"))
               : "";
  words += d.nerves ? " A nerve monitor watched, as the conditions say." : "";
  words += d.hints ? " Hints were given, as the conditions say." : "";
  document.paragraph(words);
  add_plan(d, seed, document);
}

void add_drilling_preview(const BoneDefinition& d, const PreviewRequest& request,
                          Preview& preview) {
  const protocols::PlannedTrial trial = procedure_of(d, request);
  add_timeline(d, trial, preview);
  const std::size_t bone = bone_of(d, trial);
  add_seen(d, bone, preview);
  preview.objects = *objects_of(protocols::placed_bone(d, bone), d.drilling.scale);
  add_objects(preview);
  preview.document.heading("What is felt");
  const std::vector<BurrForce> burrs = protocols::burr_forces(d);
  if (burrs.empty()) {
    preview.document.paragraph("No tool is a burr.");
  } else {
    add_burr_figure(burrs, d.drilling.force_limit, preview);
    add_burr_table(burrs, preview);
  }
  std::vector<DeviceDemand> demands;
  for (const BurrForce& burr : burrs) {
    demands.push_back({"flat bone under " + burr.tool, burr.stiffness, 0.0});
  }
  add_certified(d, demands, preview);
  add_plan(d, request.seed, preview.document);
}

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
  static SharedCache<FeltBone, std::vector<SpaceObject>> kept(2);
  const FeltBone felt{bone.model, bone.placement, scale};
  return kept.get(felt,
                  [&] { return std::make_shared<const std::vector<SpaceObject>>(made(felt)); });
}

}  // namespace haptrial::experiments
