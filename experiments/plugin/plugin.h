#pragma once

#include <Eigen/Core>

#include "experiments/plugin/plugin_abi.h"

namespace haptrial {
namespace analysis {
class Score;
}
namespace device {
struct OwnDevice;
}
namespace scene {
struct KindOfField;
}
}  // namespace haptrial

namespace haptrial::experiments {

class Study;

// What a class looks like in memory depends on the compiler, on the instruction set that Eigen
// aligns for, and on the headers (HAPTRIAL_PLUGIN_HEADERS: program's version and their checksum).
#define HAPTRIAL_PLUGIN_TEXT_OF(x) #x
#define HAPTRIAL_PLUGIN_TEXT(x) HAPTRIAL_PLUGIN_TEXT_OF(x)
#if defined(__AVX512F__)
#define HAPTRIAL_PLUGIN_ALIGNMENT "64"
#elif defined(__AVX__)
#define HAPTRIAL_PLUGIN_ALIGNMENT "32"
#else
#define HAPTRIAL_PLUGIN_ALIGNMENT "16"
#endif
// clang-format off
#define HAPTRIAL_PLUGIN_ABI                                                             \
  HAPTRIAL_PLUGIN_HEADERS ", C++ ABI " HAPTRIAL_PLUGIN_TEXT(__GXX_ABI_VERSION) "."      \
  HAPTRIAL_PLUGIN_TEXT(_GLIBCXX_USE_CXX11_ABI) ", Eigen "                               \
  HAPTRIAL_PLUGIN_TEXT(EIGEN_WORLD_VERSION) "." HAPTRIAL_PLUGIN_TEXT(EIGEN_MAJOR_VERSION) \
  "." HAPTRIAL_PLUGIN_TEXT(EIGEN_MINOR_VERSION) " aligned to " HAPTRIAL_PLUGIN_ALIGNMENT
// clang-format on
#define HAPTRIAL_PLUGIN_MARK "haptrial-plug-in-abi:"

/// Takes what a plug-in has. Each object lives as long as the program; a name that is taken, by the
/// program or by another plug-in, is refused: the command ends with a sentence and status 2.
/// Calls of one plug-in, from its `add` alone. @throws std::invalid_argument for such a name
class PluginParts {
 public:
  virtual ~PluginParts() = default;
  virtual void protocol(const Study& study) = 0;             // experiments/studies/study.h
  virtual void device(const device::OwnDevice& device) = 0;  // core/device/own_devices.h
  virtual void field(const scene::KindOfField& kind) = 0;    // core/scene/read/field_kinds.h
  virtual void score(const analysis::Score& score) = 0;      // analysis/scores/score.h
  /// What its keys are, for `haptrial keys`: lines "PATH | DEFAULT | MEANING", as
  /// "fields.NAME.width | | distance at which ...". DEFAULT stays empty where the reader says it.
  virtual void key_words(const char* lines) = 0;
};

/// What the entry point gives; texts of static duration.
struct PluginEntry {
  const char* mark;     // HAPTRIAL_PLUGIN_MARK HAPTRIAL_PLUGIN_ABI: found in the file before any of
                        // its code runs
  const char* name;     // letters, digits, '-', '_'
  const char* version;  // likewise, and '.'
  void (*add)(PluginParts&);
};

}  // namespace haptrial::experiments

/// HAPTRIAL_PLUGIN("springs", "1.0", add): once in a shared object, outside of every namespace.
///
/// The command loads it before it reads anything else, and never lets it go. It takes the program's
/// own functions and registries, and links none of its libraries (haptrial::plugin has their
/// headers alone). `add` runs on the main thread, may throw InputError, and must not start threads,
/// open devices or write files: it runs with every command, --help among them.
///
/// What a plug-in has is called by the threads that its interfaces name. On the servo thread (tick,
/// read, write, force, record and whatever they call) it must not allocate or free memory, lock,
/// wait, read or write files, print, throw, or take more than a small part of a period: nothing
/// interrupts it, and the participant feels a late force. The envelope limits its forces as any
/// others; nothing else stands between a mistake of a plug-in and the session.
#define HAPTRIAL_PLUGIN(name, version, add)                                                     \
  extern "C" __attribute__((visibility("default"))) const ::haptrial::experiments::PluginEntry* \
  haptrial_plugin() {                                                                           \
    static const ::haptrial::experiments::PluginEntry entry{                                    \
        HAPTRIAL_PLUGIN_MARK HAPTRIAL_PLUGIN_ABI, name, version, add};                          \
    return &entry;                                                                              \
  }
