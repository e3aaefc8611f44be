// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <utility>  // before Asio 1.18, which uses std::exchange without including it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <set>
#include <type_traits>

#include "kontur/base/error.h"
#include "kontur/base/stop.h"
#include "viewer/server/access.h"
#include "viewer/server/http_api.h"

// The one file that includes Boost.Beast, which is slow to compile. All of its objects and coroutines live on one network
// thread; what takes time runs on thread pools.

namespace kontur::viewer {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestHeader = 8 << 10;
constexpr std::size_t kLargestMessage = 4 << 20;
/// Behind the message that is being sent, which may be of any size: a page that takes less of what it is told is cut off.
constexpr std::size_t kMostWaitingBytes = 64 << 20;
constexpr std::size_t kBytesPerSecond = 1 << 20;  ///< least speed of long bodies
constexpr std::size_t kMostDrained = 1 << 20;
constexpr int kWorkers = 4;
constexpr int kMostImports = 2;  ///< at a time: each may be large
constexpr const char* kSocket = "/api/socket";
constexpr const char* kImports = "/api/import/";

/// Programs that kontur starts (a browser, the reader of an import) must not keep the port and the connections open.
void keep_to_this_process(int descriptor) { fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

std::string text(beast::string_view view) { return {view.data(), view.size()}; }

class PageSocket;
class Connection;

}  // namespace

/// What all connections share.
struct ServerCore {
    ServerCore(Workspace& its_workspace, const ServerOptions& its_options)
        : workspace(its_workspace),
          api(its_workspace),
          options(its_options),
          last_use(Clock::now()),
          acceptor(io),
          clock(io),
          last_words(io) {}

    Workspace& workspace;
    HttpApi api;
    ServerOptions options;
    Access access;
    std::set<PageSocket*> sockets;
    std::set<Connection*> requests;  ///< the connections over which requests come
    PageId last_page = 0;
    int connections = 0, imports = 0;
    Clock::time_point last_use;
    StopSource ending;       ///< of all that is worked on
    asio::io_context io{1};  ///< destroyed before what the connections refer to in their destructors
    tcp::acceptor acceptor;
    asio::steady_timer clock, last_words;
    asio::thread_pool calls{1};        ///< messages of the pages, in order
    asio::thread_pool work{kWorkers};  ///< slices, meshes, files

    asio::awaitable<void> accept();
    bool make_room();
    asio::awaitable<void> watch_the_clock();
    void broadcast(const std::string& message);
    void stop();
};

namespace {

/// Counts something for as long as it lives.
class Slot {
public:
    explicit Slot(int& count) : count_(&count) { ++count; }
    Slot(Slot&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
        if (count_) --*count_;
    }

private:
    int* count_;
};

/// Waits, without holding up the network's thread, for what is made on a pool's. Afterwards that coroutine goes on on its
/// own thread again, whose objects the other one never touches.
template <class Make>
asio::awaitable<std::invoke_result_t<Make&>> made_on(asio::thread_pool& pool, Make make) {
    const auto run = [&make]() -> asio::awaitable<std::invoke_result_t<Make&>> { co_return make(); };
    co_return co_await asio::co_spawn(pool, run, asio::use_awaitable);
}

/// Errors come as values: most of them are clients that go.
auto into(beast::error_code& error) { return asio::redirect_error(asio::use_awaitable, error); }

/// One open page: messages in, one at a time, and replies and events out.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
public:
    PageSocket(ServerCore& core, Slot slot, tcp::socket socket)
        : core_(core), slot_(std::move(slot)), stream_(std::move(socket)), buffer_(kLargestMessage), id_(++core.last_page) {}
    ~PageSocket() { core_.sockets.erase(this); }

    /// For as long as the page is there; `self` keeps this.
    asio::awaitable<void> serve([[maybe_unused]] std::shared_ptr<PageSocket> self,
                                http::request<http::string_body> request) {
        beast::error_code error;
        prepare();
        co_await stream_.async_accept(request, into(error));
        if (error) co_return;
        core_.sockets.insert(this);
        if (!co_await greet()) co_return;
        // The next message is read only when this one is answered, so a flood waits in the sender's socket.
        while (!is_closing_) {
            co_await stream_.async_read(buffer_, into(error));
            core_.last_use = Clock::now();
            if (error) co_return leave();
            if (is_closing_) co_return;
            if (!stream_.got_text()) co_return close(websocket::close_code::unknown_data);
            const std::string message = beast::buffers_to_string(buffer_.data());
            buffer_.consume(buffer_.size());
            std::string reply = co_await made_on(core_.calls, [&] { return core_.workspace.call(message, id_); });
            send(std::make_shared<const std::string>(std::move(reply)));
        }
    }

    /// Events wait until the page has been greeted.
    void tell(const std::shared_ptr<const std::string>& message) {
        if (is_greeted_) send(message);
        else held_back_.push_back(message);
    }

private:
    void prepare() {
        stream_.set_option(websocket::stream_base::timeout{std::chrono::seconds(10), std::chrono::seconds(60), true});
        stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
            response.set(http::field::sec_websocket_protocol, "kontur");
            response.set(http::field::server, "kontur");
        }));
        stream_.read_message_max(kLargestMessage);
        stream_.auto_fragment(false);
    }

    asio::awaitable<bool> greet() {
        std::string greeting, problem;
        const auto ask = [&] {
            try {
                greeting = core_.workspace.greeting(id_);
            } catch (const std::exception& error) {
                problem = error.what();
            }
            return problem.empty();
        };
        if (!co_await made_on(core_.calls, ask)) {
            turn_away(problem);
            co_return false;
        }
        is_greeted_ = true;
        send(std::make_shared<const std::string>(std::move(greeting)));
        for (const auto& message : held_back_) send(message);
        held_back_.clear();
        co_return true;
    }

    void turn_away(const std::string& problem) {
        send(std::make_shared<const std::string>(notice_event("error", problem)));
        close(websocket::close_code::internal_error);
    }

    void send(const std::shared_ptr<const std::string>& message) {
        if (is_closing_) return;
        if (!unsent_.empty()) waiting_bytes_ += message->size();
        if (waiting_bytes_ > kMostWaitingBytes) return cut_off();
        unsent_.push_back(message);
        if (unsent_.size() == 1) asio::co_spawn(core_.io, write(shared_from_this()), asio::detached);
    }

    asio::awaitable<void> write([[maybe_unused]] std::shared_ptr<PageSocket> self) {
        beast::error_code error;
        while (!unsent_.empty()) {
            stream_.text(true);
            co_await stream_.async_write(asio::buffer(*unsent_.front()), into(error));
            if (error) co_return cut_off();
            unsent_.pop_front();
            if (!unsent_.empty()) waiting_bytes_ -= unsent_.front()->size();
        }
        if (reason_) co_await stream_.async_close(*reason_, into(error));
    }

    /// After what it has been sent so far.
    void close(websocket::close_code reason) {
        is_closing_ = true;
        reason_ = reason;
        leave();
        if (unsent_.empty()) asio::co_spawn(core_.io, write(shared_from_this()), asio::detached);
    }

    void cut_off() {
        is_closing_ = true;
        leave();
        beast::error_code ignored;
        stream_.next_layer().socket().close(ignored);
    }

    /// After what it has asked for so far.
    void leave() {
        if (core_.sockets.erase(this) == 0) return;
        asio::post(core_.calls, [&core = core_, id = id_] { core.workspace.left(id); });
    }

    ServerCore& core_;
    Slot slot_;
    websocket::stream<beast::tcp_stream> stream_;
    beast::flat_buffer buffer_;
    const PageId id_;
    bool is_greeted_ = false, is_closing_ = false;
    std::optional<websocket::close_code> reason_;  ///< why it is closed by us
    std::vector<std::shared_ptr<const std::string>> held_back_;
    std::deque<std::shared_ptr<const std::string>> unsent_;
    std::size_t waiting_bytes_ = 0;
};

/// One HTTP connection: a request at a time; becomes a PageSocket by an upgrade.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(ServerCore& core, tcp::socket socket)
        : core_(core), slot_(core.connections), stream_(std::move(socket)), buffer_(128 << 10) {
        core_.requests.insert(this);
    }
    ~Connection() { core_.requests.erase(this); }

    /// Which one goes first where there is no room for a new one: those that have never shown the token, then those between
    /// two requests, which a browser opens again; each by how long nothing has come. Others stay.
    bool may_go() const { return !is_known_ || is_waiting_; }
    bool goes_before(const Connection& other) const {
        return std::pair(is_known_, last_sign_) < std::pair(other.is_known_, other.last_sign_);
    }

    void drop() {
        slot_.reset();
        core_.requests.erase(this);
        stream_.close();
    }

    /// Until the client goes, or becomes a page; `self` keeps this.
    asio::awaitable<void> serve([[maybe_unused]] std::shared_ptr<Connection> self) {
        for (int patience_s = core_.options.request_timeout_s; true; patience_s = core_.options.keep_alive_s) {
            beast::error_code error = co_await read_header(std::chrono::seconds(patience_s));
            std::optional<HttpReply> reply;
            if (!error) reply = check_header();
            if (!error && !reply && target_.path == kSocket) co_return upgrade();
            if (!error && !reply) error = co_await read_body();
            if (error) reply = refusal_of(error);
            if (error && !reply) break;  // it has gone, or is too slow
            keep_alive_ = !reply && parser_->get().keep_alive();
            if (!reply) reply = co_await work();
            import_.reset();
            if (!co_await write(std::move(*reply))) co_return;
            if (!keep_alive_) break;
        }
        co_await end();
    }

private:
    using Request = http::request<http::string_body>;

    static std::vector<std::string> values(const Request& request, http::field field) {
        std::vector<std::string> found;
        const auto range = request.equal_range(field);
        for (auto it = range.first; it != range.second; ++it) found.push_back(text(it->value()));
        return found;
    }

    static RequestHead head_of(const Request& request) {
        return {text(request.method_string()),
                parse_target(text(request.target())),
                values(request, http::field::host),
                values(request, http::field::origin),
                values(request, http::field::authorization),
                values(request, http::field::sec_websocket_protocol),
                websocket::is_upgrade(request)};
    }

    /// What a client is told that sent no request; nothing to one that has gone.
    static std::optional<HttpReply> refusal_of(beast::error_code error) {
        if (error == http::error::header_limit || error == http::error::buffer_overflow)
            return error_reply(431, "too_large", "the request's header is larger than 8 KiB");
        if (error == http::error::body_limit) return error_reply(413, "too_large", "the request's body is too large");
        const bool is_malformed = error.category() == http::make_error_code(http::error::bad_method).category();
        if (is_malformed && error != http::error::end_of_stream && error != http::error::partial_message)
            return error_reply(400, "invalid_input", "this is no HTTP request");
        return std::nullopt;
    }

    asio::awaitable<beast::error_code> read_header(std::chrono::seconds patience) {
        is_waiting_ = true;
        parser_.emplace();
        parser_->header_limit(kLargestHeader);
        // Checked again, by target, once the header is known; the parser would refuse imports by its own limit.
        parser_->body_limit(HttpApi::body_limit(kImports));
        stream_.expires_after(patience);
        beast::error_code error;
        co_await http::async_read_header(stream_, buffer_, *parser_, into(error));
        if (!slot_) co_return asio::error::operation_aborted;  // dropped just as the header came
        is_waiting_ = false;
        last_sign_ = core_.last_use = Clock::now();
        co_return error;
    }

    /// Why it is refused, if it is.
    std::optional<HttpReply> check_header() {
        const Request& request = parser_->get();
        const RequestHead head = head_of(request);
        if (const auto refused = refusal(head, core_.access))
            return error_reply(refused->status, refused->kind, refused->message);
        is_known_ = is_known_ || shows_token(head, core_.access);
        host_ = head.host.front();
        opening_.reset();
        if (const auto named = request.find("Kontur-Opening"); named != request.end()) opening_ = text(named->value());
        if (!head.target) return error_reply(400, "invalid_input", "the address is malformed");
        target_ = *head.target;
        if (head.is_upgrade != (target_.path == kSocket))
            return error_reply(404, "not_found", "there is nothing at this address");
        if (head.is_upgrade) return std::nullopt;
        return check_body();
    }

    std::optional<HttpReply> check_body() {
        const std::uint64_t limit = HttpApi::body_limit(target_.path), length = parser_->content_length().value_or(0);
        if (length > limit)
            return error_reply(413, "too_large",
                               fmt::format("the request's body has {} bytes; the limit is {}", length, limit));
        parser_->body_limit(limit);
        if (!target_.path.starts_with(kImports)) return std::nullopt;
        if (core_.imports >= kMostImports)
            return error_reply(413, "too_large", "other files are being imported; try again after them");
        import_.emplace(core_.imports);
        return std::nullopt;
    }

    asio::awaitable<beast::error_code> read_body() {
        const std::uint64_t length = parser_->content_length().value_or(0);
        stream_.expires_after(
            std::chrono::seconds(core_.options.request_timeout_s + static_cast<long>(length / kBytesPerSecond)));
        beast::error_code error;
        co_await http::async_read(stream_, buffer_, *parser_, into(error));
        co_return error;
    }

    void upgrade() {
        stream_.expires_never();
        core_.requests.erase(this);
        const auto socket = std::make_shared<PageSocket>(core_, std::move(*slot_), stream_.release_socket());
        asio::co_spawn(core_.io, socket->serve(socket, parser_->release()), asio::detached);
    }

    asio::awaitable<HttpReply> work() {
        Request request = parser_->release();
        HttpRequest http_request{text(request.method_string()), target_, std::move(request.body()), opening_};
        const auto make = core_.api.prepare(std::move(http_request));
        StopSource stop;
        asio::co_spawn(core_.io, watch(shared_from_this(), stop), asio::detached);
        const auto run = [&] {
            const StopCallback end(core_.ending.token(), [&] { stop.request_stop(); });
            return make(stop.token());
        };
        HttpReply reply = co_await made_on(core_.work, run);
        beast::error_code ignored;
        stream_.socket().cancel(ignored);  // the watch
        co_return reply;
    }

    /// Nothing is worked on for a client that has gone: that is how a page cancels. What it sends already, ahead of our
    /// reply, stays in the socket.
    asio::awaitable<void> watch([[maybe_unused]] std::shared_ptr<Connection> self, StopSource stop) {
        beast::error_code error;
        co_await stream_.socket().async_wait(tcp::socket::wait_read, into(error));
        char byte = 0;
        if (error) co_return;
        if (recv(stream_.socket().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) stop.request_stop();
    }

    /// Whether it has been taken.
    asio::awaitable<bool> write(HttpReply reply) {
        last_sign_ = core_.last_use = Clock::now();
        http::response<http::string_body> response;
        response.version(11);
        response.result(static_cast<unsigned>(reply.status));
        response.set(http::field::server, "kontur");
        response.set(http::field::content_type, reply.content_type);
        for (const auto& [key, value] : security_headers(host_)) response.set(key, value);
        for (const auto& [key, value] : reply.headers) response.set(key, value);
        response.keep_alive(keep_alive_);
        const std::size_t size = reply.body.size();
        response.body() = std::move(reply.body);
        response.prepare_payload();
        stream_.expires_after(
            std::chrono::seconds(core_.options.reply_timeout_s + static_cast<long>(size / kBytesPerSecond)));
        beast::error_code error;
        co_await http::async_write(stream_, response, into(error));
        co_return !error;
    }

    /// Closes without a reset, which would take the reply from a client that is still sending.
    asio::awaitable<void> end() {
        beast::error_code error;
        stream_.socket().shutdown(tcp::socket::shutdown_send, error);
        stream_.expires_after(std::chrono::seconds(2));
        for (std::size_t drained = 0; drained < kMostDrained;) {
            buffer_.consume(buffer_.size());
            drained += co_await stream_.async_read_some(buffer_.prepare(64 << 10), into(error));
            if (error) co_return;
        }
    }

    ServerCore& core_;
    std::optional<Slot> slot_;  ///< until it is dropped
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    bool is_known_ = false;    ///< by the token, which only the user's own programs have
    bool is_waiting_ = false;  ///< for a request's header
    Clock::time_point last_sign_ = Clock::now();
    std::optional<http::request_parser<http::string_body>> parser_;
    std::optional<Slot> import_;
    std::string host_ = "127.0.0.1";
    Target target_;  ///< of the request
    std::optional<std::string> opening_;
    bool keep_alive_ = false;
};

}  // namespace

asio::awaitable<void> ServerCore::accept() {
    while (acceptor.is_open()) {
        beast::error_code error;
        tcp::socket socket = co_await acceptor.async_accept(into(error));
        if (error || !acceptor.is_open() || !make_room()) continue;
        socket.set_option(tcp::no_delay(true), error);
        keep_to_this_process(socket.native_handle());
        const auto connection = std::make_shared<Connection>(*this, std::move(socket));
        asio::co_spawn(io, connection->serve(connection), asio::detached);
    }
}

/// Whoever opens connections and says nothing must not shut the page out.
bool ServerCore::make_room() {
    if (connections < options.most_connections) return true;
    Connection* first = nullptr;
    for (Connection* connection : requests)
        if (connection->may_go() && (!first || connection->goes_before(*first))) first = connection;
    if (!first) return false;
    first->drop();
    return true;
}

asio::awaitable<void> ServerCore::watch_the_clock() {
    for (beast::error_code error; !error;) {
        clock.expires_after(std::chrono::milliseconds(250));
        co_await clock.async_wait(into(error));
        const bool is_reading = !workspace.wait_for(std::chrono::milliseconds(0));
        if (!sockets.empty() || is_reading) last_use = Clock::now();
        if (options.idle_timeout_s > 0 && Clock::now() - last_use > std::chrono::seconds(options.idle_timeout_s))
            co_return stop();
    }
}

void ServerCore::broadcast(const std::string& message) {
    asio::post(io, [this, shared = std::make_shared<const std::string>(message)] {
        const std::set<PageSocket*> now = sockets;  // telling one may remove it
        for (PageSocket* socket : now) socket->tell(shared);
    });
}

void ServerCore::stop() {
    beast::error_code ignored;
    acceptor.close(ignored);
    io.stop();
}

Server::Server(Workspace& workspace, const ServerOptions& options)
    : core_(std::make_unique<ServerCore>(workspace, options)) {
    core_->access.token = options.token.empty() ? random_token() : options.token;
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), options.port);
    beast::error_code error;
    core_->acceptor.open(endpoint.protocol(), error);
    if (!error) core_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) core_->acceptor.bind(endpoint, error);
    if (!error) core_->acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) throw Error(ErrorKind::io, fmt::format("cannot listen on 127.0.0.1:{}: {}", options.port, error.message()));
    keep_to_this_process(core_->acceptor.native_handle());
    core_->access.port = core_->acceptor.local_endpoint().port();
    workspace.on_event([core = core_.get()](const std::string& message) { core->broadcast(message); });
}

Server::~Server() {
    core_->workspace.on_event({});
    core_->ending.request_stop();
    for (asio::thread_pool* pool : {&core_->calls, &core_->work}) {
        pool->stop();  // what waits is dropped, what runs is finished
        pool->join();
    }
}

std::string Server::address() const {
    return fmt::format("http://127.0.0.1:{}/#{}", core_->access.port, core_->access.token);
}

void Server::run() {
    asio::co_spawn(core_->io, core_->accept(), asio::detached);
    asio::co_spawn(core_->io, core_->watch_the_clock(), asio::detached);
    core_->io.run();
}

void Server::stop_soon() {
    asio::post(core_->io, [core = core_.get()] {
        core->last_words.expires_after(std::chrono::seconds(1));
        core->last_words.async_wait([core](beast::error_code) { core->stop(); });
    });
}

void Server::stop() {
    asio::post(core_->io, [core = core_.get()] { core->stop(); });
}

}  // namespace kontur::viewer
