#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/propose.h"
#include "pipeline/mapping/view.h"
#include "platform/error.h"

namespace cgsr::app {

/// Draws a line in space over an image of the camera, bent as its lens does; what lies behind the camera or nearer than .1 m is left out.
/// \param a_W, b_W  its ends [m]. \param camera  of the image, with its distortion. \param picture  of the camera's size, B G R.
void draw_line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const geometry::Pose& X_WC,
               const geometry::Camera& camera, cv::Mat& picture);

/// A sheet for a person who accepts or refuses proposals: for each one the image that shows it longest, with the proposal drawn in, its number
/// (as in the proposals' file, from 1), how many images show it and how far it is off them.
///
/// \param input  the video or folder that `views` come from. \param camera  of the images, with its distortion.
/// \return the sheet, B G R; or why an image of the drive cannot be read any more.
Result<cv::Mat> proposal_sheet(std::span<const mapping::Proposal> proposals, std::span<const mapping::View> views,
                               const geometry::Camera& camera, const std::string& input);

}  // namespace cgsr::app
