#pragma once

#include <deque>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "experiments/preview/space_objects.h"

namespace haptrial::experiments {

/// A preview while it is put together: one or several parts (preview.h, trials_parts.h), then
/// draw_figures().
class Preview {
 public:
  Preview() = default;
  Preview(Preview&&) = default;
  Preview& operator=(Preview&&) = default;
  Preview(const Preview&) = delete;  // the document points to its drawings
  Preview& operator=(const Preview&) = delete;

  analysis::Document document;
  std::string language;              // of headings and controls, "de"; empty: English
  std::vector<SpaceObject> objects;  // of the trial, that its film shows

  /// Adds a figure that gnuplot is to draw, or one that is drawn already.
  void add(analysis::Figure figure, std::string svg = "");
  /// Draws all figures that are not drawn yet. @throws RunError without gnuplot
  void draw_figures();
  /// The page with its scripts, which play and turn what pictures show.
  std::string html() const;

 private:
  std::deque<analysis::Drawing> drawings_;
};

}  // namespace haptrial::experiments
