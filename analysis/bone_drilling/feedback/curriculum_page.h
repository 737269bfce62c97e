#pragma once

#include <string>
#include <vector>

#include "core/bone/curriculum/curriculum.h"

namespace haptrial::analysis::drilling {

/// The curriculum with titles and units of the quantities that its criteria ask for.
bone::Curriculum with_titles(bone::Curriculum curriculum);

/// How a trainee stands in a curriculum, as a section of a page: a row for each case with what its
/// criteria ask for and what the last procedure reached. HTML.
/// @param has_session_left  in which the next case would come
std::string curriculum_section(const bone::Curriculum& curriculum,
                               const bone::CurriculumStanding& standing, bool has_session_left);

/// A trainee of a class.
struct ClassTrainee {
  std::string name;
  std::string group;  // empty: there are none
  bool simulated{false};
  bone::CurriculumStanding standing;
  bool has_session_left{true};  // in which the next case would come
};

/// Everybody who learns by one curriculum.
struct CurriculumClass {
  std::string name;  // of the study
  bone::Curriculum curriculum;
  std::vector<ClassTrainee> trainees;
};

/// A page of a class: a row for each trainee, a column for each case, and below what was missed
/// most in each case. One HTML file that loads nothing.
std::string class_page(const CurriculumClass& of);

}  // namespace haptrial::analysis::drilling
