#pragma once

namespace haptrial::experiments {

/// Kinds of /events by which a resumed session says that its definition was changed meanwhile:
/// which keys, and the whole new text.
inline constexpr const char* kDefinitionChanged = "definition_changed";
inline constexpr const char* kNewDefinition = "definition";

}  // namespace haptrial::experiments
