#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http.hpp>
#include <memory>

#include "server/web_handlers.h"

namespace faba {

/// Makes a page's socket of a connection that asked for one and may have it, and tells `handlers` what
/// becomes of it. They outlive it; `counted` goes when it goes.
void open_page_socket(boost::asio::ip::tcp::socket connection,
                      const boost::beast::http::request<boost::beast::http::empty_body>& request,
                      const WebHandlers& handlers, std::uint64_t id, std::shared_ptr<void> counted);

}  // namespace faba
