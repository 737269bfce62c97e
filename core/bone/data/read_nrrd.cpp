#include <fmt/format.h>
#include <teem/nrrd.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string_view>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/bone/data/read_volume_internal.h"
#include "core/bone/data/segments.h"

namespace haptrial::bone {
namespace {

constexpr std::size_t kMostLayers = 255;  // of a segmentation

struct Forget {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
  void operator()(NrrdIoState* state) const { nrrdIoStateNix(state); }
};
using Holder = std::unique_ptr<Nrrd, Forget>;

/// teem would take other formats as well.
void check_magic(const std::string& name) {
  if (file_head(name, 7) != "NRRD000") {
    throw InputError(
        fmt::format("{}: does not begin with 'NRRD000'; choose a volume in NRRD format", name));
  }
}

/// @throws InputError for a unit that is not known. Files without one are in millimetres by the
/// custom of all programs; the format says so.
double metres(const std::string& name, const char* unit) {
  static const std::map<std::string_view, double> kUnits{{"", 1e-3},
                                                         {"m", 1.0},
                                                         {"meter", 1.0},
                                                         {"meters", 1.0},
                                                         {"metre", 1.0},
                                                         {"metres", 1.0},
                                                         {"cm", 1e-2},
                                                         {"centimeter", 1e-2},
                                                         {"centimeters", 1e-2},
                                                         {"centimetre", 1e-2},
                                                         {"centimetres", 1e-2},
                                                         {"mm", 1e-3},
                                                         {"millimeter", 1e-3},
                                                         {"millimeters", 1e-3},
                                                         {"millimetre", 1e-3},
                                                         {"millimetres", 1e-3},
                                                         {"um", 1e-6},
                                                         {"\u00b5m", 1e-6},
                                                         {"\u03bcm", 1e-6},
                                                         {"micron", 1e-6},
                                                         {"microns", 1e-6},
                                                         {"micrometer", 1e-6},
                                                         {"micrometers", 1e-6},
                                                         {"micrometre", 1e-6},
                                                         {"micrometres", 1e-6},
                                                         {"in", 25.4e-3},
                                                         {"inch", 25.4e-3},
                                                         {"inches", 25.4e-3}};
  const auto known = kUnits.find(unit == nullptr ? "" : unit);
  if (known == kUnits.end()) {
    throw InputError(fmt::format(
        "{}: its unit of length is '{}'; allowed: m, cm, mm, um, in, or their names", name, unit));
  }
  return known->second;
}

/// Whether the file says how its axes lie in the patient.
bool says_orientation(const Nrrd& nrrd) {
  switch (nrrd.space) {
    case nrrdSpaceLeftPosteriorSuperior:
    case nrrdSpaceRightAnteriorSuperior:
    case nrrdSpaceLeftAnteriorSuperior:
      return true;
    default:
      return false;
  }
}

/// Signs of x and y from the file's space to LPS.
std::optional<Eigen::Vector3d> to_lps(int space) {
  switch (space) {
    case nrrdSpaceLeftPosteriorSuperior:
    case nrrdSpaceUnknown:
    case nrrdSpace3DRightHanded:
    case nrrdSpaceScannerXYZ:
      return Eigen::Vector3d(1.0, 1.0, 1.0);
    case nrrdSpaceRightAnteriorSuperior:
      return Eigen::Vector3d(-1.0, -1.0, 1.0);
    case nrrdSpaceLeftAnteriorSuperior:
      return Eigen::Vector3d(1.0, -1.0, 1.0);
    default:
      return std::nullopt;
  }
}

bool is_given(const char* unit) { return unit != nullptr && *unit != '\0'; }

void take_places(const std::string& name, const Nrrd& nrrd, unsigned first, VolumeHead& head) {
  const bool placed = nrrd.spaceDim == 3;
  head.format = is_given(placed ? nrrd.spaceUnits[0] : nrrd.axis[first].units)
                    ? "NRRD"
                    : fmt::format("NRRD{}", kNoUnit);
  const auto signs = to_lps(nrrd.space);
  if (nrrd.spaceDim != 0 && (!placed || !signs)) {
    throw InputError(
        fmt::format("{}: its space is '{}' with {} axes; allowed: left-posterior-superior, "
                    "right-anterior-superior, left-anterior-superior",
                    name, airEnumStr(nrrdSpace, nrrd.space), nrrd.spaceDim));
  }
  if (!says_orientation(nrrd)) {
    head.notes.push_back(assumed_orientation(name, "left-posterior-superior"));
  }
  for (unsigned axis = 0; axis < 3; ++axis) {
    const NrrdAxisInfo& info = nrrd.axis[first + axis];
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    if (placed) {
      for (int i = 0; i < 3; ++i) {
        step[i] = (*signs)[i] * info.spaceDirection[i] * metres(name, nrrd.spaceUnits[i]);
      }
    } else {
      step[axis] = info.spacing * metres(name, info.units);
    }
    head.steps.col(axis) = step;
  }
  for (int i = 0; i < 3 && placed; ++i) {
    const double place = nrrd.spaceOrigin[i];
    head.origin[i] =
        std::isfinite(place) ? (*signs)[i] * place * metres(name, nrrd.spaceUnits[i]) : 0.0;
  }
  if (!head.steps.allFinite()) {
    throw InputError(
        fmt::format("{}: does not give the size of its voxels; add 'space directions' or "
                    "'spacings' to its header",
                    name));
  }
}

void take_keys(const Nrrd& nrrd, VolumeHead& head) {
  for (unsigned i = 0; i < nrrdKeyValueSize(&nrrd); ++i) {
    char* key = nullptr;
    char* value = nullptr;
    nrrdKeyValueIndex(&nrrd, &key, &value, i);
    if (key != nullptr && value != nullptr) {
      head.keys[key] = value;
      head.labels = head.labels || std::string(key).starts_with("label_");
    }
    std::free(key);  // NOLINT: teem takes them from malloc
    std::free(value);
  }
  head.labels = head.labels || names_segments(head.keys);
}

VolumeHead head_of(const std::string& name, const Nrrd& nrrd) {
  VolumeHead head;
  const unsigned first = nrrd.dim == 4 ? 1 : 0;
  take_keys(nrrd, head);
  const std::size_t most = names_segments(head.keys) ? kMostLayers : 2;
  const bool first_in_space = std::isfinite(nrrd.axis[0].spaceDirection[0]);
  if (nrrd.dim < 3 || nrrd.dim > 4 ||
      (first == 1 && (nrrd.axis[0].size > most || first_in_space))) {
    throw InputError(fmt::format(
        "{}: has {} axes{}; allowed: 3, with one value per voxel, so one volume of a series", name,
        nrrd.dim,
        first == 1 ? fmt::format(" of {} x {} x {} x {}", nrrd.axis[0].size, nrrd.axis[1].size,
                                 nrrd.axis[2].size, nrrd.axis[3].size)
                   : ""));
  }
  if (nrrd.type == nrrdTypeBlock || nrrd.type <= nrrdTypeUnknown || nrrd.type >= nrrdTypeLast) {
    throw InputError(
        fmt::format("{}: its values are not numbers; allowed: integers or real numbers", name));
  }
  head.components = first == 1 ? static_cast<int>(nrrd.axis[0].size) : 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::size_t size = nrrd.axis[first + axis].size;
    head.size[axis] = static_cast<std::int32_t>(std::min<std::size_t>(size, 1U << 30));
  }
  take_places(name, nrrd, first, head);
  return head;
}

Holder load(const std::string& name, bool head_only) {
  Holder nrrd(nrrdNew());
  const std::unique_ptr<NrrdIoState, Forget> state(nrrdIoStateNew());
  nrrdIoStateSet(state.get(), nrrdIoStateSkipData, head_only ? 1 : 0);
  if (nrrdLoad(nrrd.get(), name.c_str(), state.get()) != 0) {
    biffDone(NRRD);  // teem's own words name its functions
    throw InputError(fmt::format("{}: {}; copy or export the volume again", name,
                                 head_only ? "its header is damaged or lacks a field"
                                           : "its values are damaged or incomplete"));
  }
  return nrrd;
}

}  // namespace

SourceVolume read_nrrd(const std::filesystem::path& file, const Room& room) {
  const std::string name = file.string();
  check_magic(name);
  SourceVolume volume{head_of(name, *load(name, true)), {}};
  check_head(name, volume.head, room);
  const Holder nrrd = load(name, false);
  const std::size_t count = volume.head.count() * static_cast<std::size_t>(volume.head.components);
  if (nrrd->data == nullptr || nrrdElementNumber(nrrd.get()) != count) {
    throw InputError(fmt::format("{}: is shorter than its header states", name));
  }
  volume.values.resize(count);
  const auto look_up = nrrdFLookup[nrrd->type];
  for (std::size_t i = 0; i < count; ++i) {
    volume.values[i] = look_up(nrrd->data, i);
  }
  return volume;
}

}  // namespace haptrial::bone
