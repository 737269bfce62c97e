#pragma once

#include <cstdint>
#include <string>

#include "core/base/dynamic_library.h"

namespace haptrial::stream {

/// Formats of a stream's values in the Lab Streaming Layer.
inline constexpr std::int32_t kLslDouble = 2;
inline constexpr std::int32_t kLslText = 3;
/// Errors.
inline constexpr std::int32_t kLslTimeout = -1;
inline constexpr std::int32_t kLslLost = -2;

/// The library of the Lab Streaming Layer, loaded at run time: its functions, as its interface
/// documents them.
class LslLibrary {
 public:
  using Info = void*;
  using Xml = void*;
  using Outlet = void*;
  using Inlet = void*;

  /// Functions of outlets, and those that all need.
  /// @param name  for which the system's loader searches, or a path
  /// @throws InputError if the library is absent or lacks one of them.
  explicit LslLibrary(const std::string& name);
  /// Functions of inlets. @throws InputError if the library lacks one of them.
  void load_inlets();

  double (*local_clock)(){nullptr};
  const char* (*last_error)(){nullptr};
  void (*destroy_streaminfo)(Info){nullptr};
  Xml (*get_desc)(Info){nullptr};

  // Functions of outlets.
  Info (*create_streaminfo)(const char* name, const char* type, std::int32_t channels, double rate,
                            std::int32_t format, const char* source_id){nullptr};
  Xml (*append_child)(Xml, const char* name){nullptr};
  Xml (*append_child_value)(Xml, const char* name, const char* value){nullptr};
  Outlet (*create_outlet)(Info, std::int32_t chunk, std::int32_t max_buffered){nullptr};
  std::int32_t (*push_chunk)(Outlet, const double* values, unsigned long count,
                             const double* timestamps){nullptr};
  std::int32_t (*push_text)(Outlet, const char** text, double timestamp){nullptr};
  void (*destroy_outlet)(Outlet){nullptr};

  // Functions of inlets. A time of 0 says that no sample came.
  std::int32_t (*resolve)(Info* found, std::uint32_t room, const char* predicate,
                          std::int32_t minimum, double timeout){nullptr};
  Inlet (*create_inlet)(Info, std::int32_t max_buffered, std::int32_t chunk,
                        std::int32_t recover){nullptr};
  void (*destroy_inlet)(Inlet){nullptr};
  Info (*get_fullinfo)(Inlet, double timeout, std::int32_t* error){nullptr};
  void (*open_stream)(Inlet, double timeout, std::int32_t* error){nullptr};
  double (*time_correction)(Inlet, double* remote_time, double* uncertainty, double timeout,
                            std::int32_t* error){nullptr};
  std::int32_t (*set_postprocessing)(Inlet, std::uint32_t flags){nullptr};
  double (*pull_sample)(Inlet, double* values, std::int32_t room, double timeout,
                        std::int32_t* error){nullptr};
  double (*pull_texts)(Inlet, char** texts, std::int32_t room, double timeout,
                       std::int32_t* error){nullptr};
  void (*destroy_text)(char*){nullptr};
  std::int32_t (*get_channel_count)(Info){nullptr};
  std::int32_t (*get_channel_format)(Info){nullptr};
  double (*get_nominal_rate)(Info){nullptr};
  const char* (*get_name)(Info){nullptr};
  const char* (*get_host)(Info){nullptr};
  Xml (*child)(Xml, const char* name){nullptr};
  Xml (*next_sibling)(Xml, const char* name){nullptr};
  const char* (*child_value)(Xml, const char* name){nullptr};
  std::int32_t (*is_empty)(Xml){nullptr};

 private:
  DynamicLibrary library_;
};

}  // namespace haptrial::stream
