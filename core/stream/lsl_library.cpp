#include "core/stream/lsl_library.h"

namespace haptrial::stream {

LslLibrary::LslLibrary(const std::string& name)
    : library_(name, "the Lab Streaming Layer, https://labstreaminglayer.org") {
  library_.get(create_streaminfo, "lsl_create_streaminfo");
  library_.get(get_desc, "lsl_get_desc");
  library_.get(append_child, "lsl_append_child");
  library_.get(append_child_value, "lsl_append_child_value");
  library_.get(create_outlet, "lsl_create_outlet");
  library_.get(push_chunk, "lsl_push_chunk_dtn");
  library_.get(push_text, "lsl_push_sample_strt");
  library_.get(local_clock, "lsl_local_clock");
  library_.get(last_error, "lsl_last_error");
  library_.get(destroy_outlet, "lsl_destroy_outlet");
  library_.get(destroy_streaminfo, "lsl_destroy_streaminfo");
}

void LslLibrary::load_inlets() {
  library_.get(resolve, "lsl_resolve_bypred");
  library_.get(create_inlet, "lsl_create_inlet");
  library_.get(destroy_inlet, "lsl_destroy_inlet");
  library_.get(get_fullinfo, "lsl_get_fullinfo");
  library_.get(open_stream, "lsl_open_stream");
  library_.get(time_correction, "lsl_time_correction_ex");
  library_.get(set_postprocessing, "lsl_set_postprocessing");
  library_.get(pull_sample, "lsl_pull_sample_d");
  library_.get(pull_texts, "lsl_pull_sample_str");
  library_.get(destroy_text, "lsl_destroy_string");
  library_.get(get_channel_count, "lsl_get_channel_count");
  library_.get(get_channel_format, "lsl_get_channel_format");
  library_.get(get_nominal_rate, "lsl_get_nominal_srate");
  library_.get(get_name, "lsl_get_name");
  library_.get(get_host, "lsl_get_hostname");
  library_.get(child, "lsl_child");
  library_.get(next_sibling, "lsl_next_sibling_n");
  library_.get(child_value, "lsl_child_value_n");
  library_.get(is_empty, "lsl_empty");
}

}  // namespace haptrial::stream
