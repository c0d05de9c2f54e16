#include "src/config/starter.h"

namespace cgsr::config {

std::string_view recording_starter() {
  return R"(# A robot that follows an object in a recording. What this file does not name has its default:
# `cgsr config show FILE` prints all that takes effect, `cgsr config keys WORD` explains keys.

camera.replay.path = "recording.mp4"    # a video or a folder of images, relative to this file

# The optics of the camera in pixels. These are typical of a webcam; `cgsr calibrate camera` measures them.
[camera.pinhole]
fx_px = 600.0
fy_px = 600.0
cx_px = 319.5
cy_px = 239.5

# The object to follow: this region of the first image is learned. Or name a model: run.model = "object.model"
[run.learn]
x_px = 280
y_px = 180
width_px = 80
height_px = 120

[follow]
distance_m = 1.5        # the distance that the robot keeps from the object

[motion]
max_forward_mps = 0.3   # the base never drives faster
armed_at_start = true   # only because the base of a recording (base.kind = "kinematic", the default) has no wheels
)";
}

std::string_view webcam_starter() {
  return R"(# A robot that follows an object before a webcam. What this file does not name has its default:
# `cgsr config show FILE` prints all that takes effect, `cgsr config keys WORD` explains keys.

run.pace = "live"                       # a thread per task, in real time

# `cgsr devices` lists the cameras of this computer, each with its id; `cgsr devices camera --setup` measures the exposure.
[camera]
kind = "v4l2"
v4l2.device = "/dev/video0"
v4l2.white_balance_k = 4600             # fixed: colours are recognised only under a white balance that stays

# The optics of the camera in pixels. These are typical of a webcam; `cgsr calibrate camera` measures them.
[camera.pinhole]
fx_px = 600.0
fy_px = 600.0

# The object to follow: this region of the first image is learned. Or name a model: run.model = "object.model"
[run.learn]
x_px = 280
y_px = 180
width_px = 80
height_px = 120

[motion]
max_forward_mps = 0.3                   # the base never drives faster
armed_at_start = true                   # only because the base is an ideal one without wheels
)";
}

}  // namespace cgsr::config
