#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/evaluation/cross_fit.h"
#include "analysis/contact/evaluation/identify_contact.h"
#include "analysis/contact/evaluation/render_contact.h"

namespace haptrial::evaluation {

struct EvaluationOptions {
  PrepareOptions prepare{};
  std::vector<contact::RendererKind> renderers{contact::kRendererKinds.begin(),
                                               contact::kRendererKinds.end()};
  int resolution{64};              // of voxel and distance field
  double crease_angle{-1.0};       // force shading of proxies; negative: none [rad]
  std::optional<double> friction;  // of proxies; default: the one that fits best
  double threshold{0.001};         // position errors beyond it are places [m]
  std::optional<TextureGrid> texture{};
};

/// One rendering beside the recording.
struct EvaluatedRendering {
  contact::RendererKind kind;
  double friction{0.0};  // static and dynamic
  double radius{0.0};    // of the tool [m]
  RenderedContact rendered;
  ForceError force;
  BandError bands;
  PositionError position;  // samples of the trajectory
  NoticeableError noticeable;
  TickTimes ticks;  // [s]
};

/// Forces that another program gave for the in-trajectory, beside the recorded ones.
struct OtherRendering {
  std::string name;
  std::vector<Eigen::Vector3d> rendered;  // (n) on the probe [N]
  ForceError force;
  BandError bands;
  NoticeableError noticeable;
};

/// Another recording of the same body with the same probe. Its clocks and its load are its own.
struct NamedRecording {
  std::string name;
  ContactRecording recording;
  PrepareOptions prepare;
};

/// Friction that was fitted on each of several recordings, tested on all of them.
struct NamedCrossFit {
  std::vector<std::string> names;
  CrossFit fit;
};

/// How far renderings are from a recorded contact.
struct Evaluation {
  PreparedContact contact;
  std::size_t triangles{0};
  std::optional<FrictionFit> friction;         // absent where it was given, or no proxy renders
  std::vector<EvaluatedRendering> renderings;  // without friction, then with
  std::vector<OtherRendering> others;          // of other programs
  std::optional<IdentifiedContact> identified;
  std::optional<NamedCrossFit> cross;  // with other recordings, the first is this one
  std::vector<std::string> remarks;    // sentences: what is doubtful, what was not measured
};

/// The whole chain: recording and mesh to lag, load, registration, in-trajectory, renderings,
/// their errors and costs, and what the contact is made of. Every renderer has the same stiffness.
/// Proxies render twice, without friction and with. "ruspini" needs a radius: the probe's, or, for
/// a point, a hundredth of the body's size.
/// @throws std::invalid_argument as prepare_contact() and make_renderer(), or without a renderer.
/// Source: Morris 2006, §7.3 and §7.4.
Evaluation evaluate_rendering(const ContactRecording& recording, const contact::FeltBody& body,
                              const EvaluationOptions& options);

/// Tests on other recordings of the body the friction that fits this one best, and the other way
/// round, by the first of the renderers that has friction. Remarks on the others begin with their
/// names.
/// @param name  of the evaluated recording
/// @throws std::invalid_argument without such a renderer, and as prepare_contact(), after the name
/// of the recording that is at fault.
void add_cross_fit(Evaluation& evaluation, const std::string& name,
                   const std::vector<NamedRecording>& others, const contact::FeltBody& body,
                   const EvaluationOptions& options);

/// The metrics of another program's forces. @throws std::invalid_argument for another number of
/// them than the in-trajectory has ticks
OtherRendering measured_forces(const PreparedContact& contact, const std::string& name,
                               std::vector<Eigen::Vector3d> forces);

/// The metrics of one rendering. @param threshold  see EvaluationOptions
EvaluatedRendering measured_rendering(const PreparedContact& contact, const contact::FeltBody& body,
                                      contact::RendererKind kind,
                                      const contact::RendererOptions& options, double threshold);

}  // namespace haptrial::evaluation
