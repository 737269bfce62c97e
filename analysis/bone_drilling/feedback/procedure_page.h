#pragma once

#include <string>
#include <string_view>

#include "analysis/bone_drilling/feedback/findings.h"
#include "analysis/bone_drilling/feedback/scene.h"

namespace haptrial::analysis::drilling {

/// view.html as it stands in the source; built in.
std::string_view view_html();

/// Content of a page about one procedure.
struct ProcedurePage {
  const Findings* findings{nullptr};
  const Experts* experts{nullptr};
  std::string scene;         // scene_json()
  std::string expert_scene;  // likewise, of a procedure on the same bone; empty: none
  std::string expert_name;   // for people: whose and which that is
  std::string picture;     // PNG file of the result, for browsers that cannot turn it; may be empty
  std::string started;     // of the session, UTC
  std::string score;       // score_section(); empty: none is asked for
  std::string checklist;   // checklist_section(); likewise
  std::string curriculum;  // curriculum_section(); empty: there is none
  std::string overview;    // name of the trainee's page beside this one; empty: none
};

/// One HTML file that needs nothing else.
std::string procedure_page(const ProcedurePage& page);

}  // namespace haptrial::analysis::drilling
