// What is open, in the words of the command line.
#pragma once

#include <string>

#include "app/session/recording.hpp"

namespace catchlight::app {

/// Where the footage is, and what the command line says about it.
struct OpenedRecording {
  std::string location;
  RecordingOverrides overrides;
};

}  // namespace catchlight::app
