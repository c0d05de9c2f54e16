#pragma once

#include <memory>
#include <string>
#include <vector>

#include "platform/error.h"

namespace cgsr::hal::gpiod {

/// A line that the robot wants.
struct LineWish {
  std::string name;  ///< the line's own name, or CHIP:OFFSET, such as gpiochip0:17.
  bool output = true;
  bool active_low = false;  ///< on is the low level.
};

/// A line of this computer.
struct ListedLine {
  std::string chip;
  unsigned offset = 0;
  std::string name;      ///< empty: it has none.
  std::string consumer;  ///< empty: free.
  bool output = false;
};

/// The lines of the kernel, so that a test can replace it. Values are logical: active_low is applied below this. The
/// functions that return an int return 0 or an errno.
class LineAccess {
 public:
  virtual ~LineAccess() = default;

  /// Requests the line; an output is driven off from the first moment. \return a number for it, the lowest that is free, from 0.
  virtual Result<int> request(const LineWish& wish) = 0;
  virtual int set(int line, bool on) = 0;
  virtual int read(int line, bool& on) = 0;

  /// Gives one line back: its number may be given again.
  virtual void release(int line) = 0;

  /// Gives every line back. What an output does then is up to its chip.
  virtual void release_all() = 0;
};

/// Through libgpiod.
std::unique_ptr<LineAccess> make_line_access();

/// \return every line of every chip that can be opened.
std::vector<ListedLine> list_lines();

}  // namespace cgsr::hal::gpiod
