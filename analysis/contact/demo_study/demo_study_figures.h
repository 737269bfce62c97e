#pragma once

#include "analysis/contact/demo_study/demo_study_tables.h"
#include "analysis/document/figure.h"

namespace haptrial::evaluation {

/// A stretch of the contact from the side: the out-trajectory on the surface, the in-trajectory
/// below it, and what joins a point to its partner. Source: Morris 2006, Figures 61 and 62.
analysis::Figure trajectory_figure(const DemoStudyTables& t);
/// The scan and the path on it from the side. Source: Morris 2006, Figure 63.
analysis::Figure path_figure(const DemoStudyTables& t);
/// The force error over the size of the mesh. Source: Morris 2006, Figure 64.
analysis::Figure resolution_figure(const DemoStudyTables& t);

}  // namespace haptrial::evaluation
