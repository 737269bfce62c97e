#include "core/bone/atlas/register_ears.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/parallel.h"
#include "core/base/scratch_folder.h"

namespace haptrial::bone {
namespace {

namespace fs = std::filesystem;

constexpr int kResolutions = 3;
/// Places at which the splines' derivatives are measured before the first step, for the lengths of
/// steps; they take as long as the steps themselves.
constexpr int kMeasurementsPerIteration = 30;

/// Lines that the three steps share. Labels are carried by the nearest voxel (order 0), and beyond
/// the ear there is kBeyondEar.
constexpr const char* kEveryStep = R"((FixedInternalImagePixelType "float")
(MovingInternalImagePixelType "float")
(FixedImageDimension 3)
(MovingImageDimension 3)
(UseDirectionCosines "true")
(Registration "MultiResolutionRegistration")
(FixedImagePyramid "FixedRecursiveImagePyramid")
(MovingImagePyramid "MovingRecursiveImagePyramid")
(NumberOfResolutions 3)
(Interpolator "LinearInterpolator")
(Metric "AdvancedNormalizedCorrelation")
(ImageSampler "RandomCoordinate")
(NewSamplesEveryIteration "true")
(NumberOfSpatialSamples 4000)
(RandomSeed 1)
(Optimizer "AdaptiveStochasticGradientDescent")
(AutomaticScalesEstimation "true")
(HowToCombineTransforms "Compose")
(ResampleInterpolator "FinalBSplineInterpolator")
(FinalBSplineInterpolationOrder 0)
(Resampler "DefaultResampler")
(DefaultPixelValue 255)
(WriteResultImage "false")
(ResultImagePixelType "unsigned char")
(ResultImageFormat "mhd")
)";

struct Step {
  const char* file;
  const char* parameters;
};
constexpr std::array kSteps{Step{"rigid.txt", R"((Transform "EulerTransform")
(AutomaticTransformInitialization "true")
(AutomaticTransformInitializationMethod "CenterOfGravity")
(ImagePyramidSchedule 8 8 8 4 4 4 2 2 2)
)"},
                            Step{"affine.txt", R"((Transform "AffineTransform")
(ImagePyramidSchedule 8 8 8 4 4 4 2 2 2)
)"},
                            Step{"splines.txt", R"((Transform "BSplineTransform")
(FinalGridSpacingInPhysicalUnits 4.0)
(GridSpacingSchedule 4 2 1)
(ImagePyramidSchedule 4 4 4 2 2 2 1 1 1)
)"}};

std::vector<float> bone_density(const BoneModel& model) {
  std::vector<float> image(model.labels.size(), 0.0F);
  for (std::size_t at = 0; at < image.size(); ++at) {
    const std::uint8_t label = model.labels[at];
    if (label != 0 && looks_like_bone(model.structures[label])) {
      image[at] = model.density.empty() ? 1.0F : model.density[at];
    }
  }
  return image;
}

/// Writes NAME.mhd and NAME.raw, which elastix reads. @throws RunError
template <class T>
void write_image(const fs::path& folder, const std::string& name, const geometry::VoxelGrid& grid,
                 const std::vector<T>& values) {
  const Eigen::Vector3d origin = 1e3 * grid.origin;
  std::ofstream(folder / (name + ".mhd")) << fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "DimSize = {} {} {}\nElementSpacing = {} {} {}\nOffset = {} {} {}\n"
      "ElementType = {}\nElementDataFile = {}.raw\n",
      grid.size[0], grid.size[1], grid.size[2], 1e3 * grid.spacing, 1e3 * grid.spacing,
      1e3 * grid.spacing, origin.x(), origin.y(), origin.z(),
      sizeof(T) == 1 ? "MET_UCHAR" : "MET_FLOAT", name);
  std::ofstream raw(folder / (name + ".raw"), std::ios::binary);
  raw.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  raw.close();
  if (!raw) {
    throw RunError(
        fmt::format("{}: cannot be written; is the disk full?", (folder / name).string()));
  }
}

/// Messages between the threads and the one that waits for them.
struct Progress {
  std::atomic<std::size_t> lines{0};  // of elastix: one for each iteration and some
  std::atomic<bool> cancelled{false};
};

/// The first line of an error of ITK among a program's words.
std::string complaint_in(const std::string& words) {
  constexpr std::string_view kMark = "Description: ";
  const std::size_t mark = words.find(kMark);
  if (mark == std::string::npos) {
    return "it said nothing";
  }
  const std::size_t from = mark + kMark.size();
  return words.substr(from, words.find('\n', from) - from);
}

/// Runs elastix or transformix to its end.
/// @param ear  for the sentence about a failure
/// @returns its words
/// @throws RunError, geometry::Cancelled
std::string run(const std::vector<std::string>& words, const fs::path& folder,
                const std::string& ear, Progress& progress) {
  Pipe pipe;
  try {
    ChildProcess program({.words = words, .folder = folder, .output = pipe.to.get()});
    pipe.to.close();
    std::string said;
    const auto keep = [&](std::string_view piece) {
      progress.lines += static_cast<std::size_t>(std::ranges::count(piece, '\n'));
      said += piece;
      return true;
    };
    read_pieces(pipe.from.get(), keep, [&] { return !progress.cancelled.load(); });
    if (progress.cancelled) {
      throw geometry::Cancelled();
    }
    if (const int status = program.wait(); status != 0) {
      throw RunError(fmt::format("{} failed with status {} while {} was registered: {}",
                                 words.front(), status, ear, complaint_in(said)));
    }
    return said;
  } catch (const std::system_error& error) {
    throw RunError(
        fmt::format("labels of other ears need elastix, which could not be started ({}); "
                    "install Debian's package elastix",
                    error.code().message()));
  }
}

/// elastix minimises the negative correlation. @throws RunError
double correlation_in(const std::string& words) {
  constexpr std::string_view kMark = "Final metric value";
  const std::size_t mark = words.rfind(kMark);
  double value = 0.0;
  if (mark == std::string::npos ||
      std::sscanf(words.c_str() + mark + kMark.size(), " = %lf", &value) != 1) {
    throw RunError("elastix did not say how well an ear fits");
  }
  return -value;
}

std::vector<std::uint8_t> read_labels(const fs::path& file, std::size_t count) {
  const std::string bytes = file_text(file);
  if (bytes.size() != count) {
    throw RunError(fmt::format("{}: transformix wrote {} labels; expected: {}", file.string(),
                               bytes.size(), count));
  }
  return {bytes.begin(), bytes.end()};
}

/// Registers one ear, with files of its own in the folder that holds scan and parameters.
RegisteredEar register_ear(const BoneModel& scan, const BoneModel& ear, const fs::path& shared,
                           std::size_t number, Progress& progress) {
  const fs::path folder = shared / fmt::format("ear-{}", number);
  fs::create_directory(folder);
  write_image(folder, "ear", ear.grid, bone_density(ear));
  write_image(folder, "labels", ear.grid, ear.labels);
  // One thread: sums of several would be rounded differently on another machine.
  std::vector<std::string> words{"elastix", "-threads", "1",    "-f", "../scan.mhd",
                                 "-m",      "ear.mhd",  "-out", "."};
  for (const Step& step : kSteps) {
    words.insert(words.end(), {"-p", fmt::format("../{}", step.file)});
  }
  const std::string said = run(words, folder, ear.name, progress);
  run({"transformix", "-threads", "1", "-in", "labels.mhd", "-tp",
       fmt::format("TransformParameters.{}.txt", kSteps.size() - 1), "-out", "."},
      folder, ear.name, progress);
  return {read_labels(folder / "result.raw", scan.labels.size()), correlation_in(said)};
}

}  // namespace

std::vector<RegisteredEar> register_ears(const BoneModel& scan, std::span<const BoneModel> ears,
                                         const RegistrationOptions& options,
                                         const geometry::WorkReport& report) {
  const ScratchFolder folder("atlas");
  write_image(folder.path(), "scan", scan.grid, bone_density(scan));
  for (const Step& step : kSteps) {
    std::ofstream(folder.path() / step.file)
        << kEveryStep << step.parameters
        << fmt::format("(MaximumNumberOfIterations {})\n(NumberOfJacobianMeasurements {})\n",
                       options.iterations, kMeasurementsPerIteration * options.iterations);
  }
  std::vector<RegisteredEar> registered(ears.size());
  Progress progress;
  const int threads = std::min(threads_or_all(options.threads), static_cast<int>(ears.size()));
  SharedWork work(ears.size(), threads, [&]() -> SharedWork::Work {
    return [&](std::size_t ear) {
      registered[ear] = register_ear(scan, ears[ear], folder.path(), ear, progress);
    };
  });
  const auto lines = static_cast<double>(ears.size() * kSteps.size() * kResolutions *
                                         static_cast<std::size_t>(options.iterations));
  try {
    while (!work.ended_within(std::chrono::milliseconds(100))) {
      geometry::report_share(report, std::min(1.0, static_cast<double>(progress.lines) / lines));
    }
  } catch (...) {
    progress.cancelled = true;
    throw;
  }
  work.finish();
  return registered;
}

}  // namespace haptrial::bone
