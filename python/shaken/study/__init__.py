"""The paper: Sharma & Soni, *Soft Matter* **20**, 6608 (2024), statement by statement and figure by figure."""
