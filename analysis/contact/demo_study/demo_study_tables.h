#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/simulated_probe.h"
#include "analysis/contact/evaluation/evaluate_rendering.h"

namespace haptrial::evaluation {

/// The source's experiments made anew on a simulated duck.
struct DemoStudyOptions {
  std::uint64_t seed{1};
  double seconds{30.0};  // of the recording
  int frequency{84};     // of the scan: 141,120 triangles
  /// The source states neither force nor stiffness. This press makes the error without friction
  /// that of its Table 5.
  double press{0.65};       // mean normal force [N]
  double friction{0.2};     // of the probe on the duck
  double stiffness{300.0};  // [N/m]
};

/// A rendering of the duck: what a row of the tables says.
struct DemoStudyRow {
  std::string renderer;
  std::size_t triangles{0};
  double friction{0.0};
  double error{0.0};                 // root mean square against the recorded force [N]
  double normal_error{0.0};          // against its normal part alone: what the geometry does [N]
  double tick{0.0};                  // median [s]
  double preparation{0.0};           // [s]
  double memory{0.0};                // [bytes]
  contact::Operations operations{};  // of all ticks
  contact::Operations most{};        // of each kind, in one tick
};

struct DemoStudyTables {
  DemoStudyOptions options;
  PreparedContact contact;
  std::vector<Eigen::Vector3d> scan;  // its vertices [m]
  double mean_force{0.0};             // recorded [N]
  double scan_error{0.0};             // root mean square of the scan's distance from the duck [m]
  FrictionFit friction;               // on the whole scan
  std::vector<DemoStudyRow> table4;   // voxels at 32 and 64, proxy
  std::vector<DemoStudyRow> table5;   // proxy without friction and with
  std::vector<DemoStudyRow> table6;   // proxy on eight meshes, coarsest first
  std::vector<DemoStudyRow> shaded;   // the same with force shading (the source's Figure 64)
};

/// A duck is scanned with noise of 1 mm; a probe with the source's sensors rubs it (lag, load and
/// place unknown to the chain); the in-trajectory comes from the whole scan, as in the source.
/// @param said  is told what is done next; may be empty
/// Source: Morris 2006, §7.4.1, §7.4.2, §7.4.3, §7.4.4.
DemoStudyTables make_demo_study_tables(const DemoStudyOptions& options,
                                       const std::function<void(const std::string&)>& said = {});

// Morris 2006, Tables 4 to 6, "RMS force error" [N].
inline constexpr std::array kSourceTable4{0.136, 0.130, 0.129};
inline constexpr std::array kSourceTable5{0.132, 0.067};
inline constexpr std::array kSourceTable6{0.085, 0.031, 0.031, 0.022, 0.022, 0.015, 0.013, 0.009};

}  // namespace haptrial::evaluation
