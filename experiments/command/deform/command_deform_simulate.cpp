#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/longest_of.h"
#include "core/base/nearest.h"
#include "core/deformable/body/mesh_parts.h"
#include "core/deformable/elements/dynamic_solver.h"
#include "core/deformable/springs/spring_motion.h"
#include "core/deformable/springs/spring_tangent.h"
#include "experiments/command/arguments.h"
#include "experiments/command/deform/deform_body.h"
#include "experiments/command/deform/deform_files.h"
#include "experiments/command/deform/deform_loads.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

struct DeformSimulateOptions {
  DeformInput input;
  std::string out;
  std::string load;
  std::string model{"springs"};
  std::string constants;
  std::vector<double> three;
  double seconds{1.0};
  bool to_rest{false};
  int frames{20};
  std::optional<double> step;
  double damping{20.0};
};

constexpr double kElementStep = 1e-3;  // [s]
constexpr double kRestSpeed = 1e-5;    // of the fastest vertex [m/s]

using Eigen::Vector3d;
using Places = std::vector<Vector3d>;

/// A body in time, whatever moves it.
class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual void step() = 0;
  virtual double time() const = 0;
  virtual bool quiet() const = 0;  // so slow that it may rest
  virtual Places displacement() const = 0;
  virtual std::vector<deformable::TetState> states() const = 0;
  virtual std::size_t inverted() const = 0;
};

class SpringStepper : public Stepper {
 public:
  SpringStepper(deformable::SpringBody body, const deformable::LoadCase& load, double step,
                double damping)
      : body_(std::move(body)), motion_(body_, {step, damping}, deformable::held_vertices(load)) {
    apply(load, body_, motion_);
  }
  void step() override { motion_.step(); }
  double time() const override { return motion_.time(); }
  bool quiet() const override {
    return motion_.activity().below({kRestSpeed, 0.1 * kRestSpeed, 1e-2, 1e-3});
  }
  Places displacement() const override {
    Places u = motion_.positions();
    for (std::size_t v = 0; v < u.size(); ++v) {
      u[v] -= body_.rest[v];
    }
    return u;
  }
  std::vector<deformable::TetState> states() const override { return {}; }
  std::size_t inverted() const override { return motion_.inverted(); }

 private:
  deformable::SpringBody body_;
  deformable::SpringMotion motion_;
};

class ElementStepper : public Stepper {
 public:
  ElementStepper(const DeformBody& body, const deformable::LoadCase& load, double step,
                 double damping)
      : elastic_(body.mesh, body.elasticity),
        solver_(elastic_, load.holds, {.step = step, .mass_damping = damping}),
        force_(body.mesh.vertices.size(), Vector3d::Zero()) {
    for (const auto& nodal : load.forces) {
      force_[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
  }
  void step() override { solver_.step(force_); }
  double time() const override { return solver_.time(); }
  bool quiet() const override { return longest_of(solver_.motion().velocity) < kRestSpeed; }
  Places displacement() const override { return solver_.motion().displacement; }
  std::vector<deformable::TetState> states() const override {
    return elastic_.states(solver_.motion().displacement);
  }
  std::size_t inverted() const override { return 0; }  // the solver refuses it

 private:
  deformable::ElasticBody elastic_;
  deformable::DynamicSolver solver_;
  Places force_;
};

deformable::SpringBody springs_asked_for(const DeformBody& body, const DeformSimulateOptions& o) {
  if (o.constants.empty() == o.three.empty()) {
    throw InputError(
        "springs need --constants FILE of a calibration, or --springs with three "
        "numbers");
  }
  if (!o.three.empty()) {
    return springs_of(body, {o.three[0], o.three[1], o.three[2]});
  }
  auto springs = springs_of(body, {1.0, 1.0, 1.0});
  springs.constants = read_constants(o.constants, springs);
  return springs;
}

std::unique_ptr<Stepper> stepper_of(const DeformBody& body, const deformable::LoadCase& load,
                                    const DeformSimulateOptions& o, const MemoryBudget& budget) {
  constexpr double kOfStable = 0.5;
  const double damping = checked_real("--damping", o.damping, 0.0, 1e6);
  const auto step_or = [&](double otherwise) {
    return o.step ? checked_real("--step", *o.step, 1e-12, 10.0) : otherwise;
  };
  if (o.model == "elements") {
    if (!o.constants.empty() || !o.three.empty()) {
      throw InputError("--constants and --springs are for --model springs; elements have none");
    }
    check_memory_of(body, kByMovingElement, budget);
    return std::make_unique<ElementStepper>(body, load, step_or(kElementStep), damping);
  }
  if (o.model != "springs") {
    throw InputError(not_allowed("--model", fmt::format("'{}'", o.model), {"springs", "elements"}));
  }
  check_memory_of(body, kBySpring, budget);
  deformable::SpringBody springs = springs_asked_for(body, o);
  double mass = 0.0;
  for (const double m : springs.masses) {
    mass += m / static_cast<double>(springs.masses.size());
  }
  const double stable = deformable::stable_step(springs, deformable::held_vertices(load));
  const double step = step_or(std::min(kOfStable * stable, o.seconds / o.frames));
  return std::make_unique<SpringStepper>(std::move(springs), load, step, damping * mass);
}

/// The series that ParaView plays.
std::string series_of(const std::vector<double>& times) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    fmt::format_to(std::back_inserter(text),
                   "<DataSet timestep=\"{}\" file=\"frame-{:04}.vtu\"/>\n", times[i], i);
  }
  return text + "</Collection>\n</VTKFile>\n";
}

/// In a body that is moved by `u`.
std::size_t inverted_tetrahedra(const geometry::TetMesh& mesh, const Places& u) {
  const Places at = moved_by(mesh, u);
  return static_cast<std::size_t>(std::ranges::count_if(
      mesh.tetrahedra, [&](const auto& t) { return !(deformable::six_volumes(at, t) > 0.0); }));
}

void check_finite(const Places& u, double time) {
  for (const Vector3d& v : u) {
    if (!v.allFinite()) {
      throw InputError(
          fmt::format("the body flies apart by {:.4g} s; take a smaller --step or "
                      "larger constants",
                      time));
    }
  }
}

int deform_simulate(const DeformSimulateOptions& options) {
  constexpr int kMostFrames = 100000;
  const DeformBody body = load_deform_body(options.input);
  const auto loads =
      loads_of(body, options.load.empty() ? std::vector<std::string>() : std::vector{options.load});
  const double seconds = checked_real("--seconds", options.seconds, 1e-9, 1e6);
  const int frames = checked_number("--frames", options.frames, 1, kMostFrames);
  const MemoryBudget budget(options.input.max_memory);
  const auto stepper = stepper_of(body, loads[0].load, options, budget);
  exchange::NewFolder out(options.out);
  Progress progress("simulating", seconds);
  watch_for_interrupt();
  std::vector<double> times;
  std::size_t inverted = 0;
  const auto write = [&] {
    const Places u = stepper->displacement();
    check_finite(u, stepper->time());
    inverted = std::max(inverted, inverted_tetrahedra(body.mesh, u));
    write_state(out.place(fmt::format("frame-{:04}.vtu", times.size())), body.mesh, u,
                stepper->states());
    out.write(fmt::format("frame-{:04}.csv", times.size()), displacements_csv(body.mesh, u));
    times.push_back(stepper->time());
  };
  constexpr double kRestTime = 0.01;  // below it [s]
  double quiet_since = 0.0;
  bool rests = false;
  write();
  while (stepper->time() < seconds && !rests) {
    stepper->step();
    inverted = std::max(inverted, stepper->inverted());
    if (!stepper->quiet()) {
      quiet_since = stepper->time();
    }
    rests = options.to_rest && stepper->time() - quiet_since >= kRestTime;
    if (stepper->time() >= seconds * static_cast<double>(times.size()) / frames) {
      write();
    }
    progress.update(stepper->time(), "", 1.0);
    check_interrupt();
  }
  if (rests) {
    write();
  }
  out.write("series.pvd", series_of(times));
  out.publish();
  fmt::print("load '{}': {} frames until {:.6g} s{}\n", loads[0].load.name, times.size(),
             times.back(), options.to_rest ? rests ? ", at rest" : ", not at rest yet" : "");
  fmt::print("moved       {:.6g} mm (root mean square)\n",
             1e3 * root_mean_square(stepper->displacement()));
  if (inverted > 0) {
    fmt::print("inverted    up to {} tetrahedra\n", inverted);
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_deform_simulate(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(
      deform, "simulate", "Move a body in time or to rest",
      "haptrial deform simulate gear.toml --springs 100 100 100 --out out/motion",
      {"frames (.vtu, .csv) and series.pvd in the folder of --out", "guide-deformable.md"});
  auto& o = options_of<DeformSimulateOptions>(*sub, status, deform_simulate);
  add_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--load", o.load, "Name of the load (default: the first)");
  sub->add_option("--model", o.model, with_default("Model: springs or elements", o.model));
  sub->add_option("--constants", o.constants, "Constants of springs from a calibration (.csv)");
  sub->add_option("--springs", o.three, "Constants of springs: lengths, areas and volumes [J]")
      ->expected(3);
  sub->add_option("--seconds", o.seconds, with_default("Duration [s]", o.seconds));
  sub->add_flag("--to-rest", o.to_rest, "End when the body rests, if that is sooner");
  sub->add_option("--frames", o.frames,
                  with_default("Number of frames over the duration", o.frames));
  sub->add_option("--step", o.step,
                  fmt::format("Step [s] (default: half the stable one of springs, {} of elements)",
                              kElementStep));
  sub->add_option("--damping", o.damping, with_default("Damping by mass [1/s]", o.damping));
}

}  // namespace haptrial::experiments
