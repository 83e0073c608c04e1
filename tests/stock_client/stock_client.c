// SPDX-License-Identifier: Apache-2.0
// A client that knows nothing of Shoal but docs/monitoring.md: prints the next view of a run, one
// line per process with its metrics, and leaves. The network is configured by CYCLONEDDS_URI.
//
//   stock_client DOMAIN SECONDS    exit code 0: a view came; 1: none within SECONDS; 2: bad usage
#include <stdio.h>
#include <stdlib.h>

#include "dds/dds.h"
#include "run_view.h"

static void print_view(const shoal_idl_RunView* view) {
  printf("view %s run %s state %s env_steps %llu updates %llu events %u\n", view->schema, view->run,
         view->state, (unsigned long long)view->env_steps, (unsigned long long)view->updates,
         view->events._length);
  for (uint32_t p = 0; p < view->processes._length; ++p) {
    const shoal_idl_Metrics* process = &view->processes._buffer[p];
    printf("process %s %u host %s pid %d state %s", process->role, process->id, process->host,
           (int)process->pid, process->state);
    for (uint32_t i = 0; i < process->names._length && i < process->values._length; ++i) {
      printf(" %s=%.17g", process->names._buffer[i], process->values._buffer[i]);
    }
    printf("\n");
  }
}

static dds_entity_t create_reader(dds_entity_t participant) {
  const dds_entity_t topic =
      dds_create_topic(participant, &shoal_idl_RunView_desc, "run_view", NULL, NULL);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  return reader;
}

// Whether a view came and was printed.
static int wait_for_view(dds_entity_t participant, dds_entity_t reader, dds_duration_t most) {
  const dds_entity_t waitset = dds_create_waitset(participant);
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset, reader, 0);
  const dds_time_t deadline = dds_time() + most;
  for (;;) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    const dds_return_t taken = dds_take(reader, samples, info, 1, 1);
    if (taken > 0) {
      const int valid = info[0].valid_data;
      if (valid) print_view(samples[0]);
      dds_return_loan(reader, samples, taken);
      if (valid) return 1;
    }
    if (dds_time() >= deadline) return 0;
    dds_waitset_wait_until(waitset, NULL, 0, deadline);
  }
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: stock_client DOMAIN SECONDS\n");
    return 2;
  }
  const dds_entity_t participant =
      dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  if (participant < 0) {
    fprintf(stderr, "stock_client: no participant: %s\n", dds_strretcode(-participant));
    return 1;
  }
  const dds_entity_t reader = create_reader(participant);
  if (reader < 0) {
    fprintf(stderr, "stock_client: no reader: %s\n", dds_strretcode(-reader));
    return 1;
  }
  const int came = wait_for_view(participant, reader, DDS_SECS(atoi(argv[2])));
  if (!came) fprintf(stderr, "stock_client: no view within %s s\n", argv[2]);
  dds_delete(participant);
  return came ? 0 : 1;
}
