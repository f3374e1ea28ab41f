# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The timing of a `System`: its network of tasks and frames, latencies, queues."""
