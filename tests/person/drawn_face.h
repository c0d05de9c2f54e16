#pragma once

// A drawn face: the cascade takes it for one.

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/face_detector.h"

namespace cgsr::person {

/// \param size  in pixels, of which its height is one and a quarter.
inline void draw_face(cv::Mat& grey, int x, int y, double size) {
  const auto oval = [&](double dx, double dy, double w, double h, int value) {
    cv::ellipse(grey, {x + static_cast<int>(dx * size), y + static_cast<int>(dy * size)},
                {static_cast<int>(w * size), static_cast<int>(h * size)}, 0, 0, 360, value, cv::FILLED, cv::LINE_AA);
  };
  oval(0.0, -0.1, 0.46, 0.62, 40);  // hair
  oval(0.0, 0.05, 0.38, 0.52, 190);
  for (const double side : {-1.0, 1.0}) {
    oval(side * 0.17, -0.1, 0.11, 0.06, 90);
    oval(side * 0.17, -0.1, 0.05, 0.05, 30);
    oval(side * 0.17, -0.2, 0.12, 0.025, 60);
  }
  oval(0.0, 0.12, 0.05, 0.14, 205);
  oval(0.0, 0.2, 0.08, 0.03, 130);
  oval(0.0, 0.35, 0.14, 0.04, 100);
}

/// \return the text of a cascade that Debian ships.
inline std::string text_of_cascade(const std::string& file) {
  std::ifstream in("/usr/share/opencv4/haarcascades/" + file);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_TRUE(in) << "opencv-data's " << file << " is not there";
  return text.str();
}

inline FaceDetector detector_of_debian() {
  return FaceDetector::from_cascade(text_of_cascade("haarcascade_frontalface_alt2.xml"), {}).value();
}

}  // namespace cgsr::person
