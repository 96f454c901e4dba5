// How commands that went through footage end.
#pragma once

#include <string>

#include "app/commands/commands.hpp"
#include "app/session/session.hpp"

namespace catchlight::app {

/// Tells the user of lost frames and of what was done, writes the report to `path` where that is not empty, and fails the command
/// where the footage was damaged, or the tag never found though that was not allowed.
void finish_report(Session& session, const std::string& path, bool overwrite, Context& context);

}  // namespace catchlight::app
