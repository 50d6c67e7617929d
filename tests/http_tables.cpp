// SPDX-License-Identifier: MIT
// Linked into what runs under the thread sanitizer: lets cpp-httplib make its table of methods before any thread starts. It is made
// at the first request, under a guard that the sanitizer does not see in a library that is not built with it, so that a second
// connection's use of the table looks like a race with its making.
#include <httplib.h>

namespace wholehand {
namespace {

struct OneRequest : httplib::Server {
  OneRequest() {
    httplib::detail::BufferStream stream;
    const std::string request = "NONE / HTTP/1.1\r\n\r\n";
    stream.write(request.data(), request.size());
    bool is_closed = false;
    process_request(stream, true, is_closed, nullptr);
  }
};

[[maybe_unused]] const OneRequest made;

}  // namespace
}  // namespace wholehand
