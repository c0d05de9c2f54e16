#pragma once

#include <memory>
#include <string_view>

#include "tools/lab/box_tracker.h"

namespace cgsr::lab {

/// CAM-Shift (Bradski 1998) as OpenCV's tutorial sets it up: the hue histogram of the learned box, one bin a hue, is projected back onto the
/// image; the window moves to the mode and takes its size. (OpenCV's demonstration program, 16 bins and a mask while tracking, does worse.)
std::unique_ptr<BoxTracker> make_cam_shift();

/// cv::TrackerKCF at its best: its first update trains it and is done on the image learned from, and no threshold makes it give up.
std::unique_ptr<BoxTracker> make_kcf();

/// cv::TrackerCSRT at its best: no threshold makes it give up.
std::unique_ptr<BoxTracker> make_csrt();

// What differs from OpenCV's defaults, for the key under which a peer's boxes are kept: a change in peers.cpp that moves a box changes these.
inline constexpr std::string_view kCamShiftOptions = "180 hues, saturation from 60, value from 32, 10 iterations";
inline constexpr std::string_view kKcfOptions = "detect_thresh 0, first update on the image learned from";
inline constexpr std::string_view kCsrtOptions = "psr_threshold 0";

}  // namespace cgsr::lab
