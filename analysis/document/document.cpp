#include "analysis/document/document.h"

namespace haptrial::analysis {

void Document::heading(const std::string& text) { blocks.emplace_back(Heading{2, text}); }

void Document::subheading(const std::string& text) { blocks.emplace_back(Heading{3, text}); }

void Document::paragraph(const std::string& text) { blocks.emplace_back(Paragraph{text}); }

void Document::alarm(const std::string& text) { blocks.emplace_back(Alarm{text}); }

void Document::points(const std::vector<std::string>& lines) { blocks.emplace_back(Points{lines}); }

void Document::table(const std::vector<std::string>& names,
                     const std::vector<std::vector<std::string>>& rows,
                     const std::string& folded_under) {
  blocks.emplace_back(Table{names, rows, folded_under});
}

void Document::source(const std::string& name, const std::string& text) {
  blocks.emplace_back(Source{name, text});
}

void Document::picture(const Drawing& drawing) { blocks.emplace_back(Picture{&drawing}); }

}  // namespace haptrial::analysis
