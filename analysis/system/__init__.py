"""The timing of a `System`: its network of tasks and frames, latencies, queues, claims."""
