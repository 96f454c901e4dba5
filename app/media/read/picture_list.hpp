// Single pictures in any number of files, one after the other.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/media/read/source.hpp"

namespace catchlight::app {

/// One name as MediaSource::open takes it. Or pictures: several names, a glob ("stills/*.jpg"), a pattern whose numbers have
/// gaps. Pictures come in the order of the numbers that end their names, which are the frames' numbers, or as they were named,
/// numbered from 0, where some have no such number or the same. Throws Error as MediaSource::open, and where a glob matches
/// nothing, a picture has another size than the first, or one of several names is a video.
std::unique_ptr<MediaSource> open_footage_or_pictures(const std::vector<std::string>& names);

}  // namespace catchlight::app
