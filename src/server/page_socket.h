#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http.hpp>
#include <memory>

#include "server/web_handlers.h"

namespace faba {

/// Upgrades an authorised connection to a WebSocket and reports its events to `handlers`, which must outlive
/// it. `counted` is released at its end.
void open_page_socket(boost::asio::ip::tcp::socket connection,
                      const boost::beast::http::request<boost::beast::http::empty_body>& request,
                      const WebHandlers& handlers, std::uint64_t id, std::shared_ptr<void> counted);

}  // namespace faba
