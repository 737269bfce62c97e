#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/bone/nerve/monitor_buffer.h"
#include "protocols/interface/auxiliary_page.h"

namespace haptrial::protocols {

/// nerves.html as it stands in the source; built in.
std::string_view nerves_html();

/// The page of a nerve monitor's technician: traces, events, thresholds. Each of its events has
/// what came since the one before, samples in multiples of 0.1 uV.
class NervePage final : public AuxiliaryPage {
 public:
  std::string_view name() const override { return "nerves"; }
  std::string_view title() const override { return "nerve monitor"; }
  std::string_view html() const override { return nerves_html(); }
  Events events() override;
  /// {"channel": 0, "muted": true}, {"channel": 0, "threshold": 150e-6}, 10 to 400 uV,
  /// {"channel": 0, "search": true}: the least current that the channel answers, or
  /// {"stimulus": 0.5e-3}: the probe's current, 0.05 to 3 mA.
  void ask(const std::string& json) override;

  /// Buffer in which the monitor shows its output and takes requests.
  const std::shared_ptr<nerve::MonitorBuffer>& buffer() const { return buffer_; }

 private:
  std::shared_ptr<nerve::MonitorBuffer> buffer_{std::make_shared<nerve::MonitorBuffer>()};
};

/// Reads a request for NervePage::ask().
/// @throws InputError
nerve::MonitorOrder parse_nerve_order(const std::string& json);

}  // namespace haptrial::protocols
