#pragma once

#include <deque>
#include <string>
#include <string_view>
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

/// The scripts of a preview, in their element, as they stand in the source; built in. NONCE stands
/// for the nonce of a server that shows the page.
std::string_view preview_script();

/// Headings and controls of a preview in another language; the English words if there are none.
/// @param language  "de"; "" and "en" are English
std::string in_language(std::string_view english, std::string_view language);

/// A page with its headings in another language, marked as such; all else stays.
std::string with_headings_in(std::string page, std::string_view language);

}  // namespace haptrial::experiments
