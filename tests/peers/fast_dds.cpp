// A ROS 2 peer on Fast DDS itself, which only knows the ROS 2 names and types, with the service mapping of
// rmw_fastrtps: reads topics, commands a vacuum, calls services and an action, and prints one JSON line.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/common/WriteParams.h>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::GUID_t;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SampleIdentity;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using eprosima::fastrtps::rtps::WriteParams;
using Bytes = std::vector<uint8_t>;

// Any type: bytes of little-endian CDR after the four bytes of encapsulation.
class AnyType : public TopicDataType {
public:
    explicit AnyType(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 1 << 20;
        m_isGetKeyDefined = false;
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const Bytes& body = *static_cast<Bytes*>(data);
        const uint8_t header[4] = {0, 1, 0, 0};
        std::memcpy(payload->data, header, 4);
        std::memcpy(payload->data + 4, body.data(), body.size());
        payload->length = static_cast<uint32_t>(body.size() + 4);
        payload->encapsulation = CDR_LE;
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        static_cast<Bytes*>(data)->assign(payload->data + 4, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        const auto size = static_cast<uint32_t>(static_cast<Bytes*>(data)->size() + 4);
        return [size] { return size; };
    }
    void* createData() override { return new Bytes(); }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

static DomainParticipant* participant;
static Publisher* publisher;
static Subscriber* subscriber;

static void wait_for(const char* what, const std::function<bool()>& is_so) {
    for (int i = 0; i < 3000; ++i) {
        if (is_so()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::fprintf(stderr, "waited 30 s for %s\n", what);
    std::exit(1);
}

static Topic* topic(const std::string& name, const std::string& type) {
    TypeSupport support(new AnyType(type));
    support.register_type(participant);
    return participant->create_topic(name, type, TOPIC_QOS_DEFAULT);
}

static DataWriter* writer(const std::string& name, const std::string& type) {
    DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    return publisher->create_datawriter(topic(name, type), qos);
}

static DataReader* reader(const std::string& name, const std::string& type, bool latched = false) {
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = latched ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().depth = 1000;
    return subscriber->create_datareader(topic(name, type), qos);
}

static bool take(DataReader* from, Bytes& body, SampleInfo& info) {
    while (from->take_next_sample(&body, &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) return true;
    }
    return false;
}

template <typename T> static T read(const Bytes& body, size_t at) {
    T value{};
    if (at + sizeof(T) <= body.size()) std::memcpy(&value, body.data() + at, sizeof(T));
    return value;
}

template <typename T> static Bytes bytes(T value) {
    Bytes body(sizeof(T));
    std::memcpy(body.data(), &value, sizeof(T));
    return body;
}

// A service client: requests name the reader for the responses.
class Client {
public:
    Client(const std::string& name, const std::string& package, const std::string& type)
        : name_(name), requests_(writer("rq/jamgrip/" + name + "Request", package + "::dds_::" + type + "_Request_")),
          responses_(reader("rr/jamgrip/" + name + "Reply", package + "::dds_::" + type + "_Response_")) {
        wait_for(name.c_str(), [this] {
            PublicationMatchedStatus matched;
            SubscriptionMatchedStatus responding;
            requests_->get_publication_matched_status(matched);
            responses_->get_subscription_matched_status(responding);
            n_readers_ = matched.current_count;
            n_writers_ = responding.current_count;
            return 0 < n_readers_ && 0 < n_writers_;
        });
    }
    Bytes call(Bytes request) {
        WriteParams parameters;
        parameters.related_sample_identity().writer_guid(responses_->guid());
        requests_->write(&request, parameters);
        const auto sent = parameters.sample_identity();
        Bytes response;
        wait_for(("a response of " + name_).c_str(), [&] {
            SampleInfo info;
            while (take(responses_, response, info)) {
                const auto& related = info.related_sample_identity;
                const bool is_mine = related.writer_guid() == responses_->guid() || related.writer_guid() == sent.writer_guid();
                if (is_mine && related.sequence_number() == sent.sequence_number()) return true;
            }
            return false;
        });
        return response;
    }

private:
    std::string name_;
    DataWriter* requests_;
    DataReader* responses_;
    int n_readers_ = 0, n_writers_ = 0;
};

static std::set<int64_t> times(DataReader* clock) {
    std::set<int64_t> found;
    Bytes body;
    SampleInfo info;
    while (take(clock, body, info)) {
        found.insert(read<int32_t>(body, 0) * INT64_C(1000000000) + read<uint32_t>(body, 4));
    }
    return found;
}

int main() {
    const char* domain = std::getenv("ROS_DOMAIN_ID");
    auto* factory = DomainParticipantFactory::get_instance();
    participant = factory->create_participant(domain ? std::atoi(domain) : 0, PARTICIPANT_QOS_DEFAULT);
    publisher = participant->create_publisher(PUBLISHER_QOS_DEFAULT);
    subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    auto* clock = reader("rt/clock", "rosgraph_msgs::msg::dds_::Clock_");
    auto* vacuum = reader("rt/jamgrip/vacuum_state", "jamgrip_msgs::msg::dds_::VacuumState_");
    auto* mesh = reader("rt/jamgrip/membrane/mesh", "shape_msgs::msg::dds_::Mesh_", true);
    auto* feedback = reader("rt/jamgrip/simulate_steps/_action/feedback", "simulation_interfaces::action::dds_::SimulateSteps_FeedbackMessage_");
    auto* command = writer("rt/jamgrip/vacuum_cmd", "std_msgs::msg::dds_::Float64_");
    Bytes body;
    SampleInfo info;
    wait_for("the clock", [&] { return !times(clock).empty(); });
    wait_for("the latched mesh", [&] { return take(mesh, body, info); });

    const std::string srv = "simulation_interfaces::srv", action = "simulation_interfaces::action";
    Client set("set_simulation_state", srv, "SetSimulationState");
    const int paused = set.call(bytes<uint8_t>(2))[0];
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto before = times(clock);
    Client step("step_simulation", srv, "StepSimulation");
    const int stepped = step.call(bytes<uint64_t>(7))[0];
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    // While time is paused, the last message is published repeatedly.
    size_t n_ticks = 0;
    for (const auto time : times(clock)) n_ticks += before.count(time) == 0;

    PublicationMatchedStatus matched;
    wait_for("a reader of commands", [&] {
        command->get_publication_matched_status(matched);
        return 0 < matched.current_count;
    });
    Bytes wanted = bytes<double>(-30000.0);
    command->write(&wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    step.call(bytes<uint64_t>(20));
    double setpoint = 0.0;
    wait_for("the command's effect", [&] {
        while (take(vacuum, body, info)) {
            // Stamp, length of the frame's name, name, then the gauge pressure and its setpoint.
            const size_t end = 12 + read<uint32_t>(body, 8);
            setpoint = read<double>(body, (end + 7) / 8 * 8 + 8);
        }
        return setpoint < -1.0;
    });

    Client send("simulate_steps/_action/send_goal", action, "SimulateSteps_SendGoal");
    Client result("simulate_steps/_action/get_result", action, "SimulateSteps_GetResult");
    Bytes goal(16, 7);
    Bytes request = goal;
    const Bytes steps = bytes<uint64_t>(5);
    request.insert(request.end(), steps.begin(), steps.end());
    const int accepted = send.call(request)[0];
    const Bytes ended = result.call(goal);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    int n_feedback = 0;
    while (take(feedback, body, info)) ++n_feedback;
    std::printf(
        "{\"paused\": %d, \"stepped\": %d, \"n_ticks\": %zu, \"setpoint\": %.1f, \"accepted\": %d, \"status\": %d, \"feedback\": %d}\n",
        paused, stepped, n_ticks, setpoint, accepted, ended[0], n_feedback);
    participant->delete_contained_entities();
    factory->delete_participant(participant);
    return 0;
}
