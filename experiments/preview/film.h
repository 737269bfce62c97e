#pragma once

#include <string>
#include <vector>

#include "experiments/preview/space_objects.h"
#include "experiments/preview/virtual_trial.h"

namespace haptrial::experiments {

/// A trial as a film, from the front and from above, as SVG: hand, objects, force as an arrow and
/// in numbers, name of the stage. Without scripts it is the picture of the strongest force; the
/// page's script (page/film.js) plays it from the data that the picture carries.
/// @param trial     of at least one sample
/// @param language  of its controls
std::string film_svg(const VirtualTrial& trial, const std::vector<SpaceObject>& objects,
                     const std::string& language = "");

/// The objects of a trial as lines, as SVG; the page's script (page/turn.js) turns them.
/// @param objects  with lines
std::string turned_svg(const std::vector<SpaceObject>& objects, const std::string& language = "");

}  // namespace haptrial::experiments
