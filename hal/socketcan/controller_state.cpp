#include "hal/socketcan/controller_state.h"

#include <linux/can/error.h>
#include <linux/can/netlink.h>

namespace cgsr::hal::socketcan {

ErrorNews read_error_frame(const can_frame& frame) {
  ErrorNews news;
  const canid_t classes = frame.can_id & CAN_ERR_MASK;
  const auto controller = frame.data[1];
  if ((classes & CAN_ERR_CRTL) != 0) {
    if ((controller & CAN_ERR_CRTL_ACTIVE) != 0) news.state = CanState::kActive;
    if ((controller & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) news.state = CanState::kWarning;
    if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) news.state = CanState::kPassive;
    news.overrun = (controller & CAN_ERR_CRTL_RX_OVERFLOW) != 0;
  }
  if ((classes & CAN_ERR_RESTARTED) != 0) {
    news.restarted = true;
    if (!news.state) news.state = CanState::kActive;
  }
  if ((classes & CAN_ERR_BUSOFF) != 0) news.state = CanState::kBusOff;  // says more than everything else in the frame
  return news;
}

CanState to_state(int can_state) {
  switch (can_state) {
    case CAN_STATE_ERROR_ACTIVE:
      return CanState::kActive;
    case CAN_STATE_ERROR_WARNING:
      return CanState::kWarning;
    case CAN_STATE_ERROR_PASSIVE:
      return CanState::kPassive;
    case CAN_STATE_BUS_OFF:
      return CanState::kBusOff;
    default:
      return CanState::kGone;
  }
}

}  // namespace cgsr::hal::socketcan
