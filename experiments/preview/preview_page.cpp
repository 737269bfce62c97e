#include "experiments/preview/preview_page.h"

#include <utility>
#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "experiments/preview/preview_script.h"
#include "experiments/preview/preview_words.h"

namespace haptrial::experiments {

void Preview::add(analysis::Figure figure, std::string svg) {
  drawings_.push_back({std::move(figure), std::move(svg)});
  document.picture(drawings_.back());
}

std::string Preview::html() const {
  std::string page = with_headings_in(analysis::to_html(document), language);
  return page.insert(page.rfind("</body>"), preview_script());
}

void Preview::draw_figures() {
  std::vector<analysis::Figure> waiting;
  for (const analysis::Drawing& drawing : drawings_) {
    if (drawing.svg.empty()) {
      waiting.push_back(drawing.figure);
    }
  }
  std::vector<analysis::Drawing> drawn = analysis::drawn(waiting);
  std::size_t next = 0;
  for (analysis::Drawing& drawing : drawings_) {
    if (drawing.svg.empty()) {
      drawing.svg = std::move(drawn[next++].svg);
    }
  }
}

}  // namespace haptrial::experiments
