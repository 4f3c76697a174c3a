// limpid._neural: the network's C interface (limpid/neural.h) for Python. limpid/_network.py checks arguments
// and documents them.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "c_interface.h"
#include "gil.h"
#include "limpid/neural.h"

namespace py = pybind11;

namespace {

using namespace limpid::python;

/// Throws Failure if a call failed. Must run on the same thread as the call, since the error text is per
/// thread.
void check(limpid_result result) {
    if (result != LIMPID_OK) throw Failure(limpid_network_last_error(), result);
}

/// Does one task after another on a thread of its own. OpenMP, with which networks compute on CPUs, keeps a
/// team of threads for each thread that uses it: a new thread for each task would start a new team.
class Worker {
  public:
    ~Worker() {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        changed_.notify_one();
        thread_.join();
    }

    std::future<void> start(std::packaged_task<void()> task) {
        std::future<void> done = task.get_future();
        {
            const std::lock_guard lock(mutex_);
            tasks_.push_back(std::move(task));
        }
        changed_.notify_one();
        return done;
    }

  private:
    void work() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
            if (tasks_.empty()) return;
            std::packaged_task<void()> task = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            task();
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::packaged_task<void()>> tasks_;
    bool ends_ = false;
    std::thread thread_{[this] { work(); }};  ///< the last member, since it uses the others
};

/// A frame that another thread computes, so that its caller can handle signals meanwhile.
struct Run {
    std::vector<std::pair<uint32_t, Array>> inputs;
    Array result;
    std::atomic<bool> wanted = true;
    std::future<void> done;

    bool isDone(std::chrono::milliseconds wait = {}) const {
        return done.wait_for(wait) == std::future_status::ready;
    }
};

/// Waits for the run, without the GIL. Throws what the handler of a signal, such as Ctrl+C, raises meanwhile.
void await(const Run& run) {
    const auto isDone = [&] {
        const py::gil_scoped_release release;
        return run.isDone(std::chrono::milliseconds(100));
    };
    while (!isDone()) handleSignals();
}

class Network {
  public:
    Network(const std::string& select, const std::string& weights) {
        limpid_device_desc device{};
        device.size = sizeof device;
        device.select = select.c_str();
        limpid_network_desc desc{};
        desc.size = sizeof desc;
        desc.weights = weights.c_str();
        limpid_network* network = nullptr;
        check(limpid_network_create(&device, &desc, &network));
        handle_.reset(network);
    }
    Network(const Network&) = delete;
    Network& operator=(const Network&) = delete;
    ~Network() {
        const py::gil_scoped_release release;  // until the arrays of the runs are given back
        worker_.reset();
        handle_.reset();
    }

    std::string deviceName() const { return limpid_network_device_name(handle_.get()); }
    std::string precision() {
        return alone([&] { return std::string(limpid_network_precision(handle_.get())); });
    }

    /// `inputs`: limpid_network_input and a float array of (height, width, components). Returns (height,
    /// width, 3). The C interface cannot give up a frame: where a signal ends the call, the worker goes on.
    Array denoise(uint32_t width, uint32_t height, uint32_t samples,
                  const std::vector<std::pair<uint32_t, Array>>& inputs) {
        giveBack();
        limpid_network_frame frame{};
        frame.size = sizeof frame;
        frame.width = width;
        frame.height = height;
        frame.samples = samples;
        for (const auto& [input, array] : inputs) {
            if (input >= LIMPID_NETWORK_INPUT_MAX) throw std::invalid_argument("there is no such input");
            checkReadable(array, width, height);
            frame.inputs[input] = hostImage<limpid_host_image>(array.data(), array);
        }
        Array result({py::ssize_t{height}, py::ssize_t{width}, py::ssize_t{3}});
        frame.color = hostImage<limpid_host_output>(result.mutable_data(), result);
        auto run = std::make_unique<Run>();
        run->inputs = inputs;
        run->result = result;
        run->done = worker_->start(std::packaged_task<void()>([this, frame, &wanted = run->wanted] {
            const std::lock_guard lock(mutex_);
            if (wanted) check(limpid_network_denoise(handle_.get(), &frame));
        }));
        try {
            await(*run);
        } catch (...) {
            run->wanted = false;
            abandoned_.push_back(std::move(run));
            throw;
        }
        run->done.get();
        return result;
    }

    void set(const std::string& name, double value) {
        alone([&] { check(limpid_network_set(handle_.get(), name.c_str(), value)); });
    }
    double get(const std::string& name) {
        return alone([&] {
            double value = 0.0;
            check(limpid_network_get(handle_.get(), name.c_str(), &value));
            return value;
        });
    }

  private:
    /// Gives the arrays of finished frames back that nobody waited for. Needs the GIL, as they are Python's.
    void giveBack() {
        std::erase_if(abandoned_, [](const auto& run) { return run->isDone(); });
    }

    /// Calls `use` without the GIL while no frame is computed.
    template <typename Use>
    std::invoke_result_t<const Use&> alone(const Use& use) {
        giveBack();
        const py::gil_scoped_release release;
        const std::lock_guard lock(mutex_);
        return use();
    }

    struct Destroy {
        void operator()(limpid_network* network) const { limpid_network_destroy(network); }
    };
    std::mutex mutex_;  ///< one thread at a time may use a network
    std::unique_ptr<limpid_network, Destroy> handle_;
    std::vector<std::unique_ptr<Run>> abandoned_;  ///< the worker may still compute them
    std::unique_ptr<Worker> worker_ = std::make_unique<Worker>();
};

py::dict inputs() {
    const std::pair<const char*, limpid_network_input> all[] = {
        {"diffuse", LIMPID_NETWORK_INPUT_DIFFUSE},
        {"specular", LIMPID_NETWORK_INPUT_SPECULAR},
        {"emission", LIMPID_NETWORK_INPUT_EMISSION},
        {"albedo", LIMPID_NETWORK_INPUT_ALBEDO},
        {"normal", LIMPID_NETWORK_INPUT_NORMAL},
        {"depth", LIMPID_NETWORK_INPUT_DEPTH},
        {"diffuse_variance", LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE},
        {"specular_variance", LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE},
        {"albedo_variance", LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE},
        {"normal_variance", LIMPID_NETWORK_INPUT_NORMAL_VARIANCE},
        {"depth_variance", LIMPID_NETWORK_INPUT_DEPTH_VARIANCE}};
    py::dict dict;
    for (const auto& [name, value] : all) dict[name] = static_cast<int>(value);
    return dict;
}

}  // namespace

PYBIND11_MODULE(_neural, m) {
    translateFailures();
    using Unlocked = py::call_guard<py::gil_scoped_release>;
    m.attr("INPUTS") = inputs();
    m.def("parameters", [] { return listParameters(limpid_network_parameter); });
    py::class_<Network>(m, "Network")
        .def(py::init<const std::string&, const std::string&>(), Unlocked())
        .def("device_name", &Network::deviceName)
        .def("precision", &Network::precision)
        .def("denoise", &Network::denoise)
        .def("set", &Network::set)
        .def("get", &Network::get);
}
