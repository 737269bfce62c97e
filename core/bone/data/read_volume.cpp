#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/bone/data/read_volume_internal.h"

namespace haptrial::bone {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr rlim_t kPatience = 300;  // of the reading process [s of its processor]

json told(const VolumeHead& head) {
  const auto* steps = head.steps.data();
  const auto* origin = head.origin.data();
  return {{"size", head.size},
          {"components", head.components},
          {"steps", std::vector<double>(steps, steps + 9)},
          {"origin", std::vector<double>(origin, origin + 3)},
          {"labels", head.labels},
          {"hounsfield", head.hounsfield},
          {"keys", head.keys},
          {"format", head.format},
          {"notes", head.notes}};
}

VolumeHead heard(const json& words) {
  VolumeHead head;
  words.at("size").get_to(head.size);
  words.at("components").get_to(head.components);
  const auto steps = words.at("steps").get<std::vector<double>>();
  const auto origin = words.at("origin").get<std::vector<double>>();
  head.steps = Eigen::Map<const Eigen::Matrix3d>(steps.data());
  head.origin = Eigen::Map<const Eigen::Vector3d>(origin.data());
  words.at("labels").get_to(head.labels);
  words.at("hounsfield").get_to(head.hounsfield);
  words.at("keys").get_to(head.keys);
  words.at("format").get_to(head.format);
  words.at("notes").get_to(head.notes);
  return head;
}

/// Runs in the other process: the result is JSON on the pipe, values in the shared memory.
json read_and_share(const fs::path& file, const Room& room, int memory) {
  try {
    const SourceVolume volume = read_here(file, room);
    if (!write_fully(memory, volume.values.data(), volume.values.size() * sizeof(float))) {
      return {{"run_error", fmt::format("{}: no memory to hand it over", file.string())}};
    }
    return {{"head", told(volume.head)}};
  } catch (const InputError& error) {
    return {{"input_error", error.what()}};
  } catch (const std::bad_alloc&) {
    return {{"input_error", fmt::format("{}: needs more memory than there is", file.string())}};
  } catch (...) {  // a library's own words would be of no use
    return {{"input_error", fmt::format("{}: is damaged and cannot be read", file.string())}};
  }
}

/// The work of the other process.
void be_the_reader(const fs::path& file, const Room& room, int pipe, int memory) {
  const rlimit patience{kPatience, kPatience};
  setrlimit(RLIMIT_CPU, &patience);
  for (const int stop : {SIGTERM, SIGINT}) {
    std::signal(stop, SIG_DFL);
  }
  const std::string words =
      read_and_share(file, room, memory).dump(-1, ' ', true, json::error_handler_t::replace);
  write_fully(pipe, words.data(), words.size());
}

/// All that the other process says. @throws Cancelled where the report asks to stop.
std::string listen(int pipe, const geometry::WorkReport& report) {
  bool cancelled = false;
  std::string words = read_to_end(pipe, [&] {
    cancelled = report && !report(0.0);
    return !cancelled;
  });
  if (cancelled) {
    throw geometry::Cancelled();
  }
  return words;
}

std::string words_of_reader(const fs::path& file, const Room& room, int memory,
                            const geometry::WorkReport& report) {
  try {
    Pipe pipe;
    const ChildProcess reader([&] { be_the_reader(file, room, pipe.to.get(), memory); });
    pipe.to.close();
    return listen(pipe.from.get(), report);
  } catch (const std::system_error& error) {
    throw RunError(fmt::format("{}: cannot start a process to read it: {}", file.string(),
                               error.code().message()));
  }
}

BigArray<float> fetch(const std::string& name, int memory, std::size_t count) {
  BigArray<float> values(count);
  auto* bytes = reinterpret_cast<char*>(values.data());
  std::size_t done = 0;
  while (done < count * sizeof(float)) {
    const ssize_t size =
        pread(memory, bytes + done, count * sizeof(float) - done, static_cast<off_t>(done));
    if (size <= 0) {
      throw RunError(fmt::format("{}: cannot be handed over", name));
    }
    done += static_cast<std::size_t>(size);
  }
  return values;
}

SourceVolume with_missing_noted(const std::string& name, SourceVolume volume) {
  const auto missing =
      std::ranges::count_if(volume.values, [](float value) { return !std::isfinite(value); });
  if (missing > 0) {
    volume.head.notes.push_back(fmt::format(
        "{} of the {} values of {} are not finite numbers; they are taken as the lowest", missing,
        volume.values.size(), name));
  }
  return volume;
}

/// @throws InputError where no value is finite.
void make_finite(const std::string& name, BigArray<float>& values) {
  float lowest = std::numeric_limits<float>::max();
  for (const float value : values) {
    lowest = std::isfinite(value) ? std::min(lowest, value) : lowest;
  }
  if (lowest == std::numeric_limits<float>::max()) {
    throw InputError(fmt::format("{}: none of its values is a finite number", name));
  }
  for (float& value : values) {
    value = std::isfinite(value) ? value : lowest;
  }
}

}  // namespace

void check_system_memory(const std::string& what, double bytes) {
  std::ifstream info("/proc/meminfo");
  std::string key;
  double kilobytes = 0.0;
  for (std::string rest; info >> key >> kilobytes && std::getline(info, rest);) {
    if (key == "MemAvailable:" && bytes > 1024.0 * kilobytes) {
      throw InputError(fmt::format("{} may take {:.3g} GB of memory; the system has {:.3g} GB",
                                   what, bytes / 1e9, 1024.0 * kilobytes / 1e9));
    }
  }
}

void check_head(const std::string& name, const VolumeHead& head, const Room& room) {
  constexpr std::int32_t kLargest = 32767;
  for (const std::int32_t size : head.size) {
    if (size < 1 || size > kLargest) {
      throw InputError(fmt::format("{}: has {} x {} x {} voxels; allowed: 1 to {} along an axis",
                                   name, head.size[0], head.size[1], head.size[2], kLargest));
    }
  }
  const Eigen::Vector3d edges = head.steps.colwise().norm();
  const double volume = std::abs(head.steps.determinant());
  if (!head.steps.allFinite() || !head.origin.allFinite() || !(edges.minCoeff() > 1e-6) ||
      !(edges.maxCoeff() < 0.1) || !(volume > 0.1 * edges.prod())) {
    throw InputError(
        fmt::format("{}: its voxels are {:.4g} x {:.4g} x {:.4g} mm; allowed: 0.001 to 100 mm "
                    "along axes that span a volume",
                    name, 1e3 * edges[0], 1e3 * edges[1], 1e3 * edges[2]));
  }
  // The library's values, ours, the copy handed over and the one received.
  constexpr double kBytes = 8.0 + 3.0 * sizeof(float);
  room(fmt::format("{}: {} x {} x {} voxels", name, head.size[0], head.size[1], head.size[2]),
       kBytes * static_cast<double>(head.count()) * head.components);
}

std::string assumed_orientation(const std::string& name, const char* assumed) {
  return fmt::format(
      "{} does not say how its axes lie in the patient; {} is assumed, and left and right may be "
      "exchanged",
      name, assumed);
}

SourceVolume read_here(const fs::path& path, const Room& room) {
  if (fs::is_directory(path)) {
    return read_dicom(path, room);
  }
  refuse_special_file(path);
  std::string name = path.filename().string();
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto ends = [&](const char* ending) { return name.ends_with(ending); };
  if (ends(".nrrd") || ends(".nhdr")) {
    return with_missing_noted(path.string(), read_nrrd(path, room));
  }
  if (ends(".nii") || ends(".nii.gz")) {
    return with_missing_noted(path.string(), read_nifti(path, room));
  }
  if (ends(".dcm")) {
    return read_dicom(path, room);
  }
  throw InputError(
      fmt::format("{}: is not a volume by its name; allowed: .nrrd, .nhdr, .nii, .nii.gz, .dcm, or "
                  "a folder with a DICOM series",
                  path.string()));
}

SourceVolume read_volume(const fs::path& file, const Room& room,
                         const geometry::WorkReport& report) {
  if (!fs::exists(file)) {
    throw InputError(fmt::format("{}: no such file or folder", file.string()));
  }
  const Descriptor memory(memfd_create("volume", MFD_CLOEXEC));
  if (memory.get() < 0) {
    throw RunError(
        fmt::format("{}: cannot get memory to read it: {}", file.string(), std::strerror(errno)));
  }
  const std::string words = words_of_reader(file, room, memory.get(), report);
  const json answer = json::parse(words, nullptr, false);
  if (answer.is_discarded()) {
    throw InputError(fmt::format(
        "{}: is damaged, so that its reader crashed; copy or export it again", file.string()));
  }
  if (answer.contains("input_error")) {
    throw InputError(answer["input_error"].get<std::string>());
  }
  if (answer.contains("run_error")) {
    throw RunError(answer["run_error"].get<std::string>());
  }
  SourceVolume volume{heard(answer.at("head")), {}};
  const auto components = static_cast<std::size_t>(volume.head.components);
  volume.values = fetch(file.string(), memory.get(), components * volume.head.count());
  make_finite(file.string(), volume.values);
  return volume;
}

}  // namespace haptrial::bone
