#pragma once

#include <string>
#include <variant>
#include <vector>

#include "analysis/document/figure.h"

namespace haptrial::analysis {

/// A figure and its picture as an SVG file.
struct Drawing {
  Figure figure;
  std::string svg;
};

/// Content of a report, apart from how it is written down: plain texts, nothing escaped.
struct Document {
  struct Heading {
    int level{2};  // 2 or 3; the title is 1
    std::string text;
  };
  struct Paragraph {
    std::string text;
  };
  struct Alarm {  // must not be overlooked
    std::string text;
  };
  struct Points {  // the lines that matter
    std::vector<std::string> lines;
  };
  struct Table {
    std::vector<std::string> heading;
    std::vector<std::vector<std::string>> rows;  // as long as the heading
    std::string folded_under{};                  // a long one; empty: open
  };
  struct Source {  // a file, word for word
    std::string name;
    std::string text;
  };
  struct Picture {
    const Drawing* drawing;  // not null; outlives the document
  };
  using Block = std::variant<Heading, Paragraph, Alarm, Points, Table, Source, Picture>;

  std::string title;
  std::string subtitle;
  bool simulated{false};
  std::vector<Block> blocks;

  void heading(const std::string& text);
  void subheading(const std::string& text);
  void paragraph(const std::string& text);
  void alarm(const std::string& text);
  void points(const std::vector<std::string>& lines);
  void table(const std::vector<std::string>& names,
             const std::vector<std::vector<std::string>>& rows,
             const std::string& folded_under = "");
  void source(const std::string& name, const std::string& text);
  void picture(const Drawing& drawing);
};

/// One HTML file that needs nothing else: pictures, style and files are inside. Whatever the
/// document says is escaped.
std::string to_html(const Document& document);

/// The same as Markdown (GitHub's tables), its pictures as links to NAME.svg beside it.
std::string to_markdown(const Document& document);

}  // namespace haptrial::analysis
