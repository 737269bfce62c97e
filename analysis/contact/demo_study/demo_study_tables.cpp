#include "analysis/contact/demo_study/demo_study_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

using contact::RendererKind;
using Eigen::Vector3d;

/// 180 to 64,980 triangles: near the source's 0.2k to 64k.
constexpr std::array kFrequencies{3, 5, 7, 12, 17, 21, 57};
constexpr double kShadingCrease = 1.2;  // [rad]: facets of the coarsest duck meet at less
constexpr double kProbeLag = 0.04;      // that the chain has to find [s]

/// The recorded force without what lies along the surface.
std::vector<Vector3d> normal_part(const PreparedContact& c) {
  std::vector<Vector3d> force;
  for (std::size_t i = 0; i < c.force.size(); ++i) {
    force.emplace_back(std::max(0.0, c.force[i].dot(c.normal[i])) * c.normal[i]);
  }
  return force;
}

class DemoStudyRenderings {
 public:
  explicit DemoStudyRenderings(const PreparedContact& contact)
      : contact_(contact), normal_(normal_part(contact)) {}

  DemoStudyRow row(const contact::FeltBody& body, RendererKind kind,
                   const contact::RendererOptions& options) const {
    const RenderedContact r = render_contact(contact_, body, kind, options);
    return {std::string(contact::name_of(kind)),
            body.mesh.triangles.size(),
            options.friction.dynamic_friction,
            force_error(contact_.force, r.force).root_mean_square,
            force_error(normal_, r.force).root_mean_square,
            tick_times(r.tick_seconds).median,
            r.preparation,
            r.memory,
            r.operations,
            r.most};
  }

 private:
  const PreparedContact& contact_;
  std::vector<Vector3d> normal_;
};

PreparedContact recorded_demo(const contact::FeltBody& scan, const DemoStudyOptions& o) {
  SimulatedProbe probe;
  probe.seconds = o.seconds;
  probe.press = o.press;
  probe.friction = o.friction;
  probe.lag = kProbeLag;
  probe.seed = o.seed;
  probe.world_from_body = Eigen::Translation3d(0.2, 1.1, -0.4) *
                          Eigen::AngleAxisd(2.2, Vector3d(0.3, 1.0, -0.6).normalized());
  PrepareOptions options;
  options.stiffness = o.stiffness;
  options.free = {{0.0, probe.free_seconds - 0.5}};
  return prepare_contact(simulate_probe(duck_radius, probe), scan, options);
}

double scan_error(const geometry::Mesh& scan) {
  double squares = 0.0;
  for (const Vector3d& v : scan.vertices) {
    const double off = v.norm() - duck_radius(v.normalized());
    squares += off * off / static_cast<double>(scan.vertices.size());
  }
  return std::sqrt(squares);
}

}  // namespace

DemoStudyTables make_demo_study_tables(const DemoStudyOptions& o,
                                       const std::function<void(const std::string&)>& said) {
  const auto say = [&](const std::string& what) {
    if (said) {
      said(what);
    }
  };
  say("scanning the duck");
  const contact::FeltBody scan(
      scanned_mesh(duck_radius, {.frequency = o.frequency, .seed = o.seed}));
  DemoStudyTables t;
  t.options = o;
  t.scan = scan.mesh.vertices;
  t.scan_error = scan_error(scan.mesh);
  say("lag, load, registration, in-trajectory");
  t.contact = recorded_demo(scan, o);
  t.mean_force = force_error(t.contact.force, t.contact.force).mean_force;
  const DemoStudyRenderings renderings(t.contact);
  say("proxy and voxels");
  for (const int resolution : {32, 64}) {
    t.table4.push_back(renderings.row(scan, RendererKind::kVoxel, {.resolution = resolution}));
    t.table4.back().renderer = fmt::format("voxel, {}^3", resolution);
  }
  const DemoStudyRow proxy = renderings.row(scan, RendererKind::kProxy, {});
  t.table4.push_back(proxy);
  say("friction");
  t.friction = fit_friction(t.contact, scan, RendererKind::kProxy, {});
  contact::RendererOptions with;
  with.friction = {t.friction.friction, t.friction.friction};
  t.table5 = {proxy, renderings.row(scan, RendererKind::kProxy, with)};
  for (const int frequency : kFrequencies) {
    const contact::FeltBody coarse(radial_mesh(radius_of(scan.surface.bvh()), frequency));
    say(fmt::format("{} triangles", coarse.mesh.triangles.size()));
    t.table6.push_back(renderings.row(coarse, RendererKind::kProxy, {}));
    t.shaded.push_back(
        renderings.row(coarse, RendererKind::kProxy, {.crease_angle = kShadingCrease}));
  }
  t.table6.push_back(proxy);
  t.shaded.push_back(renderings.row(scan, RendererKind::kProxy, {.crease_angle = kShadingCrease}));
  return t;
}

}  // namespace haptrial::evaluation
