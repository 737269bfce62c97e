#include "core/bone/data/ear_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::bone {
namespace {

void lower_tegmen(EarVariation& v) { v.mastoid_roof = 6.0; }
void bring_sinus_forward(EarVariation& v) { v.sinus = 6.5; }
void shrink_antrum(EarVariation& v) { v.antrum = 0.6; }
void bare_nerve(EarVariation& v) { v.bare_nerve = true; }
void fill_cells(EarVariation& v) {
  v.cells = 0.0;
  v.spongy = 1.0;
}

constexpr std::array kVariants{
    EarVariant{"low tegmen", lower_tegmen}, EarVariant{"forward sinus", bring_sinus_forward},
    EarVariant{"small antrum", shrink_antrum}, EarVariant{"dehiscent facial nerve", bare_nerve},
    EarVariant{"sclerotic mastoid", fill_cells}};

}  // namespace

std::vector<std::string> ear_variants() {
  std::vector<std::string> names;
  for (const EarVariant& variant : kVariants) {
    names.emplace_back(variant.name);
  }
  return names;
}

void apply_ear_variant(std::string_view variant, EarVariation& variation) {
  if (variant.empty()) {
    return;
  }
  const auto found = std::find_if(kVariants.begin(), kVariants.end(),
                                  [&](const EarVariant& one) { return one.name == variant; });
  if (found == kVariants.end()) {
    throw InputError(not_allowed("the variant of the temporal bone", fmt::format("'{}'", variant),
                                 ear_variants()));
  }
  found->change(variation);
}

}  // namespace haptrial::bone
