// The formats of write_track. Private to app/track_export. Those of poses need at least one.
#pragma once

#include <string>
#include <vector>

#include "app/track_export/shot.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// TUM RGB-D benchmark (https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats): `timestamp tx ty tz qx qy qz qw` of
/// tag_from_camera, the camera OpenCV's; lines that begin with # are comments.
std::string tum_text(const std::vector<TrackRow>& rows);

/// Nuke: `frame tx ty tz rx ry rz vfov`, no comments, world +y up, camera looking along its -z. Degrees, rotation order ZXY
/// (about z first, then x, then y: world_from_camera = Ry Rx Rz), angles continuous from frame to frame. Nuke numbers a movie's
/// frames from 1 and a sequence's by their files; so do we.
std::string chan_text(const std::vector<TrackRow>& rows, const Shot& shot);

/// glTF 2.0, world +y up: a node `camera` (perspective, animated, LINEAR) and a node `tag` with a child for every object of the
/// scene, an empty at its place. In one file: the keys are in a data URI. Frames whose time, in single precision, is not after
/// the one before are left out.
std::string gltf_text(const std::vector<TrackRow>& rows, const Shot& shot);

/// The same in glTF's binary container.
std::string glb_bytes(const std::vector<TrackRow>& rows, const Shot& shot);

/// One JSON object a frame: frame, time_s, state, camera_from_tag (4 rows of 4; null where lost),
/// pose_covariance (6 rows of 6, see PoseCovariance; null where not known), exposure and black (null where
/// not measured), corner_sigma_px, ambiguity.
std::string json_lines_text(const std::vector<TrackRow>& rows);

}  // namespace catchlight::app
