// Files for other programs: the contact tick by tick, and the object that an evaluation found.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/contact/evaluation/evaluation_report.h"
#include "analysis/files/delimited.h"
#include "core/base/toml_text.h"

namespace haptrial::evaluation {
namespace {

void add_names(exchange::RowText& header, const std::string& what, const char* unit) {
  for (const char axis : {'x', 'y', 'z'}) {
    header.add(fmt::format("{}_{}_{}", what, axis, unit));
  }
}

void add_numbers(std::string& row, const Eigen::Vector3d& v) {
  fmt::format_to(std::back_inserter(row), ",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z());
}

std::string of(const char* unit, const Interval& i) {
  return fmt::format("{:.4g} to {:.4g}{}", i.low, i.high, unit);
}

/// A coefficient of friction, or the other one where the recording does not tell it.
/// @param least  below which a definition refuses it
std::string friction_line(const char* key, const Interval* own, const Interval& other,
                          double least) {
  const double value = std::max(least, (own != nullptr ? *own : other).value);
  std::string words = "the other one's; this one is not known from the recording";
  if (own != nullptr) {
    words = fmt::format("95 %: {}", of("", *own));
    if (own->value < least) {
      words = fmt::format("found as {:.4g} ({}); a definition allows no less than {:.4g}",
                          own->value, words, least);
    }
  }
  return fmt::format("{} = {:.4g}  # {}\n", key, value, words);
}

const Interval* address(const std::optional<Interval>& i) { return i ? &*i : nullptr; }

}  // namespace

std::vector<std::string> force_names(const Evaluation& evaluation) {
  std::vector<std::string> names{"force"};
  for (const EvaluatedRendering& rendering : evaluation.renderings) {
    names.push_back(name_of(rendering));
    std::ranges::replace(names.back(), ' ', '-');
  }
  for (const OtherRendering& other : evaluation.others) {
    names.push_back(other.name);
  }
  return names;
}

std::string contact_csv(const Evaluation& evaluation) {
  const PreparedContact& c = evaluation.contact;
  std::string text;
  exchange::RowText header(text, exchange::Delimited::kCsv);
  header.add("time_s").add("touching");
  add_names(header, "out", "m");
  add_names(header, "in", "m");
  for (const std::string& name : force_names(evaluation)) {
    add_names(header, name, "N");
  }
  header.end();
  for (std::size_t i = 0; i < c.time.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:.9g},{:d}", c.time[i], c.touching[i] ? 1 : 0);
    add_numbers(text, c.out[i]);
    add_numbers(text, c.in[i]);
    add_numbers(text, c.force[i]);
    for (const EvaluatedRendering& rendering : evaluation.renderings) {
      add_numbers(text, rendering.rendered.force[i]);
    }
    for (const OtherRendering& other : evaluation.others) {
      add_numbers(text, other.rendered[i]);
    }
    text += '\n';
  }
  return text;
}

std::string objects_toml(const Evaluation& evaluation, const EvaluationNames& names) {
  std::string text = fmt::format(
      "# {}{} on {}, as haptrial evaluate found it; intervals hold 95 %.\n[objects.recorded]\n"
      "mesh = {}  # put it beside the definition\nscale = {:g}\n"
      "damping = 0.0  # an object needs one [N·s/m]; the recording is not asked for it\n",
      names.simulated ? "SIMULATED: " : "", names.recording, names.mesh, toml_text(names.mesh),
      names.mesh_unit);
  if (!evaluation.identified) {
    return text + "# the recording tells neither stiffness nor friction\n";
  }
  const IdentifiedContact& found = *evaluation.identified;
  const Interval& k = found.stiffness;
  if (std::isfinite(k.value) && k.value > 0.0) {
    fmt::format_to(std::back_inserter(text), "stiffness = {:.4g}  # 95 %: {}\n", k.value,
                   of(" N/m", k));
  } else {
    fmt::format_to(std::back_inserter(text),
                   "# stiffness: the poses tell only that it is above {:.4g} N/m\n",
                   std::max(0.0, k.low));
  }
  for (const std::string& sentence : found.confounded) {
    fmt::format_to(std::back_inserter(text), "# {}\n", sentence);
  }
  const Interval* resting = address(found.static_friction);
  const Interval* moving = address(found.dynamic_friction);
  if (resting == nullptr && moving == nullptr) {
    return text + "# friction: not known from the recording\n";
  }
  text += "\n[objects.recorded.friction]\n";
  // A body at rest is held by no less than one that slides, whatever noise makes of equal ones.
  const double least = moving != nullptr ? std::max(0.0, moving->value) : 0.0;
  text += friction_line("static", resting, moving != nullptr ? *moving : *resting, least);
  text += friction_line("dynamic", moving, resting != nullptr ? *resting : *moving, 0.0);
  return text;
}

}  // namespace haptrial::evaluation
