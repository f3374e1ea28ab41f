# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a system as text: Graphviz DOT, PlantUML and Mermaid."""
