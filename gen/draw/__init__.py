"""Pictures of a system as text: Graphviz DOT, PlantUML and Mermaid."""
